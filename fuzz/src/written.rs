//! Whatever is read can be written, and is the same when it is read again.

use std::fmt::Debug;
use std::path::Path;

use crate::Sandbox;

/// Writes what a reader returned to the file `name` and reads it again with the same reader, unless the
/// sandbox is for reading only.
///
/// # Panics
/// If it cannot be written, cannot be read again, or is not what it was.
#[expect(clippy::panic, reason = "a target reports a fault by panicking")]
pub(crate) fn check<T: Debug + PartialEq, E: Debug>(
    sandbox: &Sandbox,
    name: &str,
    first: &T,
    write: impl FnOnce(&Path, &T) -> Result<(), E>,
    read: impl FnOnce(&Path) -> Result<T, E>,
) {
    if !sandbox.writes() {
        return;
    }
    let path = sandbox.fresh(name);
    if let Err(error) = write(&path, first) {
        panic!("{name} was read but cannot be written: {error:?}");
    }
    match read(&path) {
        Err(error) => panic!("{name} was written but cannot be read: {error:?}"),
        Ok(second) => check_same(name, first, &second),
    }
}

/// Largest relative difference of a number that is written and read again. Files have angles in degrees, so
/// the last bit of an angle in radians may change.
const TOLERANCE: f64 = 4.0 * f64::EPSILON;

/// Compares two values by their fields, in which NaN is equal to NaN.
///
/// # Panics
/// If they are different.
pub(crate) fn check_same<T: Debug + PartialEq>(name: &str, first: &T, second: &T) {
    if first == second {
        return;
    }
    let (first, second) = (format!("{first:?}"), format!("{second:?}"));
    for (one, other) in words(&first).zip(words(&second)) {
        assert!(is_same_word(one, other), "{name}: {one} becomes {other} in {first}");
    }
    assert_eq!(words(&first).count(), words(&second).count(), "{name}: {first} becomes {second}");
}

/// Returns the words and numbers of a value's fields.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split([' ', ',', ':', '(', ')', '[', ']', '{', '}'])
}

fn is_same_word(one: &str, other: &str) -> bool {
    let is_near = |a: f64, b: f64| (a - b).abs() <= TOLERANCE * a.abs().max(b.abs());
    one == other || matches!((one.parse(), other.parse()), (Ok(a), Ok(b)) if is_near(a, b))
}
