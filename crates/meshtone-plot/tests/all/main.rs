//! The library, used as its users use it. One test program, because each is linked with all libraries.

mod bearings;
mod dataset;
mod indicators;
mod order_map;
mod panel;
mod support;
mod tuning;
