//! Cache of the results of costly pure functions, by their arguments.

use std::sync::{Arc, Mutex, PoisonError};

/// Number of latest results that are kept: enough for a sweep of a few values, and few enough to limit
/// memory; a sky is some 20 MB.
const MAX_RESULTS: usize = 4;

/// Latest results of a pure function, shared by all threads of a process. The cases of a study differ in a
/// few values, so results that depend on other values are computed once.
#[derive(Debug, Default)]
pub struct Memo<K, V>(Mutex<Vec<(K, Arc<V>)>>);

impl<K: PartialEq, V> Memo<K, V> {
    /// Creates an empty memo.
    pub const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// Returns the result of `make`, or the earlier result for an equal key. No lock is held while `make`
    /// runs: two threads may compute the same result.
    ///
    /// # Errors
    /// The error of `make`, which is not kept.
    pub fn get<E>(&self, key: K, make: impl FnOnce(&K) -> Result<V, E>) -> Result<Arc<V>, E> {
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, result)) = kept().iter().find(|(known, _)| *known == key) {
            return Ok(result.clone());
        }
        let result = Arc::new(make(&key)?);
        let mut kept = kept();
        if kept.len() >= MAX_RESULTS {
            kept.remove(0);
        }
        kept.push((key, result.clone()));
        Ok(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equal_key_has_the_earlier_result_and_an_error_is_not_kept() {
        let memo = Memo::new();
        assert_eq!(memo.get(3, |_| Err("no")), Err("no"));
        assert_eq!(memo.get(3, |key| Ok::<_, ()>(key * 2)).as_deref(), Ok(&6));
        assert_eq!(memo.get(3, |_| Err("made again")).as_deref(), Ok(&6));
    }

    #[test]
    fn the_oldest_result_gives_way() {
        let memo = Memo::new();
        for key in 0..=MAX_RESULTS {
            memo.get(key, |_| Ok::<_, ()>(())).unwrap();
        }
        assert!(memo.get(0, |_| Err(())).is_err());
        assert!(memo.get(1, |_| Err(())).is_ok());
    }
}
