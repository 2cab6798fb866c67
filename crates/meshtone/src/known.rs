//! Results of stages that several simulations have in common.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The last results of a pure function, by its arguments: at most so many.
#[derive(Debug)]
pub(crate) struct Known<K, V, const MOST: usize>(Mutex<Vec<Arc<Entry<K, V>>>>);

/// Arguments and what was made of them, by the first thread that asked for it, while the others wait.
type Entry<K, V> = (K, OnceLock<Arc<V>>);

impl<K, V, const MOST: usize> Default for Known<K, V, MOST> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: PartialEq, V, const MOST: usize> Known<K, V, MOST> {
    /// What a function makes of its arguments, computed only once.
    ///
    /// # Arguments
    /// * `key` - all that the result depends on
    /// * `make` - the function
    pub(crate) fn get(&self, key: K, make: impl FnOnce(&K) -> V) -> Arc<V> {
        let entry = self.entry(key);
        entry.1.get_or_init(|| Arc::new(make(&entry.0))).clone()
    }

    /// The entry of some arguments, made where there is none; the oldest one gives way.
    fn entry(&self, key: K) -> Arc<Entry<K, V>> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = all.iter().find(|known| known.0 == key) {
            return known.clone();
        }
        if all.len() >= MOST {
            all.remove(0);
        }
        let entry = Arc::new((key, OnceLock::new()));
        all.push(entry.clone());
        entry
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_computed_once() {
        let known = Known::<u32, u32, 8>::default();
        let ask = |key: u32| known.get(key, |key| key * key);
        // Threads that ask at the same time get the one that the first of them computes.
        let asked: Vec<Arc<u32>> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..8).map(|_| scope.spawn(|| ask(3))).collect();
            threads.into_iter().filter_map(|thread| thread.join().ok()).collect()
        });
        assert_eq!(asked.len(), 8);
        assert!(*asked[0] == 9 && asked.iter().all(|result| Arc::ptr_eq(result, &asked[0])));
        // Other arguments have their own, and many of them push the first ones out.
        assert_eq!(
            (10..18).map(|key| *ask(key)).collect::<Vec<_>>(),
            (10..18).map(|key| key * key).collect::<Vec<_>>()
        );
        assert!(known.0.lock().is_ok_and(|all| all.len() == 8));
        assert!(!Arc::ptr_eq(&ask(3), &asked[0]));
    }
}
