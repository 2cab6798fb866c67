//! Tests with solvers of their own, which spend their time here and not in the library: the machine again with dense matrices, and the
//! face again in slices. A program beside the other tests, so that it is optimised as the library is.

mod contact_slices;
// What the other tests share with these; each program needs a part of it.
#[allow(dead_code)]
#[path = "../all/dense.rs"]
mod dense;
mod dense_oracle;
mod face_load;
mod gearbox;
mod integrator;
#[allow(dead_code)]
#[path = "../all/physics.rs"]
mod physics;
#[path = "../all/plain.rs"]
mod plain;
