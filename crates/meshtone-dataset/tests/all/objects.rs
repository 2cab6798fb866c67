//! An object store holds what a directory does.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::sync::Arc;

use crate::support::{FAST, SHARDS, bytes, plan, run};
use meshtone_dataset::generate::Part;
use meshtone_dataset::store::Destination;
use object_store::ObjectStoreExt;
use object_store::memory::InMemory;

#[test]
fn an_object_store_holds_the_same() {
    let plan = plan(FAST);
    let directory = tempfile::tempdir().unwrap();
    run(&plan, &Destination::directory(directory.path()), Part::WHOLE, 2).unwrap();
    let store = Arc::new(InMemory::new());
    let to = Destination::objects(store.clone(), "gears/first");
    // Parts of it before the rest, as on several machines.
    assert!(!run(&plan, &to, Part { number: 2, of: 2 }, 2).unwrap().complete);
    let rest = run(&plan, &to, Part::WHOLE, 2).unwrap();
    assert_eq!((rest.kept_shards, rest.written_shards, rest.complete), (4, SHARDS.len() as u64 - 4, true));
    let get = |name: &str| {
        let path = object_store::path::Path::from(format!("gears/first/{name}"));
        futures::executor::block_on(async { store.get(&path).await?.bytes().await }).unwrap().to_vec()
    };
    for (name, bytes) in bytes(directory.path()) {
        assert!(get(&name) == bytes, "{name}");
    }
    // Something else is in the bucket, but not below the prefix.
    let again = run(&plan, &Destination::objects(store.clone(), "gears"), Part::WHOLE, 1).unwrap_err();
    assert!(again.to_string().contains("has another file in it"), "{again}");
}
