//! A child and all its descendants as one thing that can be ended.

use std::process::{Child, Command};

/// Makes a command start a process group of its own, so that its children end with it.
#[cfg(unix)]
pub(super) fn isolate(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    command.process_group(0);
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
}

/// Elsewhere a child has no group: its own children may outlive it.
#[cfg(not(unix))]
pub(super) fn isolate(_command: &mut Command) {}

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
