//! Process groups: a child with all its descendants, which can be ended together and whose memory is limited.

use std::process::{Child, Command};

/// Identifiers of the running groups. None of their leaders has been reaped, so no identifier can belong to
/// another process.
#[cfg(unix)]
static RUNNING: std::sync::Mutex<std::collections::BTreeSet<u32>> =
    std::sync::Mutex::new(std::collections::BTreeSet::new());

#[cfg(unix)]
fn running() -> std::sync::MutexGuard<'static, std::collections::BTreeSet<u32>> {
    RUNNING.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Starts a command in a new process group, which allows its children to be ended with it.
///
/// # Errors
/// The error of the operating system, when the command cannot be started.
#[cfg(unix)]
pub(super) fn spawn(command: &mut Command) -> std::io::Result<Child> {
    use std::os::unix::process::CommandExt;
    // Locked until the child is registered, so [`end_all`] cannot miss it.
    let mut running = running();
    let child = command.process_group(0).spawn()?;
    running.insert(child.id());
    Ok(child)
}

/// Ends every pipeline process, with its children, and prevents further starts. Intended for a process that
/// is about to exit without unwinding, for example after an interrupt. The pipelines are in other process
/// groups, so they do not receive a terminal's interrupt.
#[cfg(unix)]
pub fn end_all() {
    use rustix::process::{Pid, Signal, kill_process, kill_process_group};
    let running = running();
    for group in running.iter().filter_map(|&number| Pid::from_raw(i32::try_from(number).ok()?)) {
        // Fails only if the group no longer exists; its leader may have moved to another group.
        let _ = kill_process_group(group, Signal::KILL);
        let _ = kill_process(group, Signal::KILL);
    }
    // The lock is never released: a thread that tries to start another process waits until the exit.
    std::mem::forget(running);
}

/// Returns true if the child has ended. The child is not reaped: until it is, the identifier of its process
/// group cannot be assigned to another process.
#[cfg(unix)]
pub(super) fn has_ended(child: &mut Child) -> bool {
    use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    matches!(waitid(WaitId::Pid(Pid::from_child(child)), options), Ok(Some(_)))
}

/// Kills the child and everything in its process group.
#[cfg(unix)]
pub(super) fn kill(child: &mut Child) {
    use rustix::process::{Pid, Signal, kill_process_group};
    // Fails only if the group no longer exists.
    let _ = kill_process_group(Pid::from_child(child), Signal::KILL);
    // Waiting for a child that moved to another group would otherwise never end.
    let _ = child.kill();
    // Removed before the child is reaped, because its identifier may be reused afterwards.
    running().remove(&child.id());
}

/// Limits the memory of the child, and of each process that it starts from now on, to `bytes`. Requests
/// beyond the limit fail. Private writable memory counts (RLIMIT_DATA), not reserved address space, of which
/// some languages take a hundred times their actual use.
///
/// # Errors
/// The error of the operating system.
#[cfg(target_os = "linux")]
pub(super) fn limit_memory(child: &Child, bytes: u64) -> std::io::Result<()> {
    use rustix::process::{Pid, Resource, Rlimit, getrlimit, prlimit};
    // A lower existing limit cannot be raised.
    let bytes = getrlimit(Resource::Data).maximum.map_or(bytes, |most| most.min(bytes));
    let limit = Rlimit { current: Some(bytes), maximum: Some(bytes) };
    prlimit(Some(Pid::from_child(child)), Resource::Data, limit)?;
    Ok(())
}

/// Does nothing: other systems cannot limit the memory of another process.
#[cfg(not(target_os = "linux"))]
pub(super) fn limit_memory(_child: &Child, _bytes: u64) -> std::io::Result<()> {
    Ok(())
}

/// Starts a command. On other systems a child has no group, so its children may outlive it.
///
/// # Errors
/// The error of the operating system, when the command cannot be started.
#[cfg(not(unix))]
pub(super) fn spawn(command: &mut Command) -> std::io::Result<Child> {
    command.spawn()
}

/// Does nothing: on other systems pipelines end when their input does.
#[cfg(not(unix))]
pub fn end_all() {}

/// Returns true if the child has ended.
#[cfg(not(unix))]
pub(super) fn has_ended(child: &mut Child) -> bool {
    matches!(child.try_wait(), Ok(Some(_)))
}

/// Kills the child.
#[cfg(not(unix))]
pub(super) fn kill(child: &mut Child) {
    // Fails only if the child has already ended.
    let _ = child.kill();
}
