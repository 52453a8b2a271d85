//! A child and all its descendants as one thing that can be ended, and whose memory has a limit.

use std::process::{Child, Command};

/// Groups that run now, by their numbers. None of them has been reaped, so none of the numbers is somebody else's.
#[cfg(unix)]
static RUNNING: std::sync::Mutex<std::collections::BTreeSet<u32>> =
    std::sync::Mutex::new(std::collections::BTreeSet::new());

#[cfg(unix)]
fn running() -> std::sync::MutexGuard<'static, std::collections::BTreeSet<u32>> {
    RUNNING.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Starts a command in a process group of its own, so that its children end with it.
///
/// # Errors
/// That of the operating system, when it cannot be started.
#[cfg(unix)]
pub(super) fn spawn(command: &mut Command) -> std::io::Result<Child> {
    use std::os::unix::process::CommandExt;
    // Held until the child is known, so that none is missed by whoever ends all.
    let mut running = running();
    let child = command.process_group(0).spawn()?;
    running.insert(child.id());
    Ok(child)
}

/// Ends every pipeline that runs as a process, with its children, and starts no more: for a process that is about to exit without
/// unwinding, as when it is interrupted. Being in groups of their own, they do not get the interrupt of a terminal.
#[cfg(unix)]
pub fn end_all() {
    use rustix::process::{Pid, Signal, kill_process, kill_process_group};
    let running = running();
    for group in running.iter().filter_map(|&number| Pid::from_raw(i32::try_from(number).ok()?)) {
        // The only failure is a group that is gone already; its leader may have moved to another one.
        let _ = kill_process_group(group, Signal::KILL);
        let _ = kill_process(group, Signal::KILL);
    }
    // Whoever wants to start another one waits for the exit.
    std::mem::forget(running);
}

/// Whether the child has ended. It is not reaped: until it is, its process group keeps its number and cannot be
/// taken for somebody else's.
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
    // The only failure is a group that is gone already.
    let _ = kill_process_group(Pid::from_child(child), Signal::KILL);
    // A child that moved to another group would be waited for without end.
    let _ = child.kill();
    // Now, as its number may be somebody else's as soon as it is reaped.
    running().remove(&child.id());
}

/// Limits the memory of the child, and of each process that it starts from now on, to so many bytes: whatever it asks for beyond is
/// refused to it. Memory that can be written and is its own counts (RLIMIT_DATA), not address space that is only reserved, of which some
/// languages take a hundred times what they use.
///
/// # Errors
/// That of the operating system.
#[cfg(target_os = "linux")]
pub(super) fn limit_memory(child: &Child, bytes: u64) -> std::io::Result<()> {
    use rustix::process::{Pid, Resource, Rlimit, getrlimit, prlimit};
    // A limit that is lower already cannot be raised.
    let bytes = getrlimit(Resource::Data).maximum.map_or(bytes, |most| most.min(bytes));
    let limit = Rlimit { current: Some(bytes), maximum: Some(bytes) };
    prlimit(Some(Pid::from_child(child)), Resource::Data, limit)?;
    Ok(())
}

/// Elsewhere nobody can limit the memory of another process.
#[cfg(not(target_os = "linux"))]
pub(super) fn limit_memory(_child: &Child, _bytes: u64) -> std::io::Result<()> {
    Ok(())
}

/// Starts a command. Elsewhere a child has no group: its own children may outlive it.
///
/// # Errors
/// That of the operating system, when it cannot be started.
#[cfg(not(unix))]
pub(super) fn spawn(command: &mut Command) -> std::io::Result<Child> {
    command.spawn()
}

/// Elsewhere pipelines end when their input does.
#[cfg(not(unix))]
pub fn end_all() {}

/// Whether the child has ended.
#[cfg(not(unix))]
pub(super) fn has_ended(child: &mut Child) -> bool {
    matches!(child.try_wait(), Ok(Some(_)))
}

/// Kills the child.
#[cfg(not(unix))]
pub(super) fn kill(child: &mut Child) {
    // The only failure is a child that has ended already.
    let _ = child.kill();
}
