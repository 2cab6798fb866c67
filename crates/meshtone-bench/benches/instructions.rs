//! Instructions of the time loop and of the stiffness stages, counted: a regression shows on a noisy machine too.
//!
//! Needs valgrind and gungraun-runner of this crate's version of gungraun; see the performance chapter of the book.
#![allow(clippy::expect_used, missing_docs)]

#[path = "cases/mod.rs"]
mod cases;

use std::hint::black_box;
use std::num::NonZeroUsize;

use gungraun::prelude::*;
use meshtone::batch::{Control, KeepChannels, simulate_many};
use meshtone::mesh::Mesh;
use meshtone::scenario::{Model, Scenario};
use meshtone::sensor::ChannelKind;
use meshtone::solver::{Block, Recorder};
use meshtone::{Stages, stages};

struct Nothing;

impl Recorder for Nothing {
    fn record(&mut self, block: &Block) {
        black_box(block.output(0));
    }
}

fn scenario(index: usize, model: Model) -> Scenario {
    let mut scenario = cases::with_full_settling(model).swap_remove(index).1;
    // A tenth of the steps: counts are proportional.
    scenario.solver.sampling_rate_hz = 1e4;
    scenario
}

fn prepared(index: usize, model: Model) -> Box<Stages> {
    Box::new(stages(&scenario(index, model)).expect("an example is valid"))
}

#[library_benchmark]
#[bench::healthy(prepared(0, Model::Linear))]
#[bench::tooth_breakage(prepared(2, Model::Linear))]
#[bench::healthy_published(prepared(0, Model::Published))]
#[bench::healthy_contact(prepared(0, Model::Contact))]
#[bench::tooth_breakage_contact(prepared(2, Model::Contact))]
fn time_loop(stages: Box<Stages>) -> Box<Stages> {
    let outputs = ChannelKind::ALL.map(ChannelKind::output);
    stages.integrate(&outputs, stages.time.first_kept_sample, &mut Nothing).expect("a solution");
    stages
}

#[library_benchmark]
#[bench::healthy(prepared(0, Model::Linear))]
#[bench::tooth_breakage(prepared(2, Model::Linear))]
#[bench::partial_face(prepared(3, Model::Linear))]
#[bench::through_face(prepared(4, Model::Linear))]
fn stiffness(stages: Box<Stages>) -> (Vec<Mesh>, Box<Stages>) {
    let points = NonZeroUsize::new(stages.meshes[0].points_per_pitch).expect("a pitch has points");
    (stages.meshes_at(points).expect("an example is valid"), stages)
}

#[library_benchmark]
#[bench::healthy(vec![scenario(0, Model::Linear); 8])]
#[bench::healthy_contact(vec![scenario(0, Model::Contact); 8])]
#[bench::tooth_breakage_contact(vec![scenario(2, Model::Contact); 8])]
fn eight_side_by_side(scenarios: Vec<Scenario>) -> usize {
    // In this thread: only its instructions are counted.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().expect("a thread");
    pool.install(|| {
        simulate_many(scenarios, &KeepChannels::default(), &Control::default(), |_, signals| {
            black_box(signals.expect("an example is valid"));
        })
    })
}

library_benchmark_group!(name = counts, benchmarks = [time_loop, stiffness, eight_side_by_side]);
main!(library_benchmark_groups = counts);
