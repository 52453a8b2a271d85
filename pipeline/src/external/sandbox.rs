//! Access of an external pipeline: its frames, its files and the system, but not the truth.
//!
//! Enforced by the kernel for the process and all processes that it starts: Landlock (Linux 5.13 and later)
//! for files, TCP and signals, seccomp for all other sockets.

use std::path::{Path, PathBuf};
use std::process::{Child, Command};

/// Restriction of a program to its files and those of the system.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sandbox {
    /// Additional readable files and directories.
    pub readable: Vec<PathBuf>,
    /// Files and directories that remain unreadable although they are beside the program's files: scenarios,
    /// results.
    pub hidden: Vec<PathBuf>,
}

/// System directories: programs, libraries, their settings and descriptions of the machine.
#[cfg(target_os = "linux")]
const SYSTEM: [&str; 14] = [
    "/usr",
    "/bin",
    "/sbin",
    "/lib",
    "/lib32",
    "/lib64",
    "/libx32",
    "/etc",
    "/opt",
    "/nix",
    "/sys",
    "/proc/sys",
    "/proc/cpuinfo",
    "/proc/meminfo",
];

/// Devices without stored data, and devices for computation. Shared memory is not among them: what a program
/// leaves there survives into the next run.
#[cfg(target_os = "linux")]
const DEVICES: [&str; 10] = [
    "/dev/null",
    "/dev/zero",
    "/dev/full",
    "/dev/random",
    "/dev/urandom",
    "/dev/dri",
    "/dev/kfd",
    "/dev/nvidia0",
    "/dev/nvidiactl",
    "/dev/nvidia-uvm",
];

/// Last path components of directories of programs, whose dependencies are beside them.
#[cfg(target_os = "linux")]
const PROGRAMS: [&str; 4] = ["bin", "sbin", "shims", "scripts"];

/// Entries of an installation that its programs need.
#[cfg(target_os = "linux")]
const INSTALLATION: [&str; 5] = ["lib", "lib64", "libexec", "share", "pyvenv.cfg"];

/// Number of bytes that are read of a script or of the settings of an environment.
#[cfg(target_os = "linux")]
const BEGINNING_BYTES: u64 = 4096;

/// File that marks a directory as a run.
#[cfg(target_os = "linux")]
const RUN_FILE: &str = "run.toml";

#[cfg(target_os = "linux")]
mod landlocked {
    use std::io::Read;

    use landlock::{
        ABI, Access, AccessFs, AccessNet, CompatLevel, Compatible, LandlockStatus, PathBeneath, PathFd,
        Ruleset, RulesetAttr, RulesetCreated, RulesetCreatedAttr, Scope,
    };
    use seccompiler::{
        BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter,
        SeccompRule,
    };

    use super::*;

    impl Sandbox {
        /// Checks if the kernel can enforce the sandbox.
        ///
        /// # Errors
        /// A description of the missing feature.
        pub fn check() -> Result<(), String> {
            rules().map(drop)
        }

        /// Starts a command in the sandbox. Images are in `scratch`, which also contains a directory for the
        /// command's temporary files.
        ///
        /// # Errors
        /// The error of the operating system, when the command cannot be started or restricted.
        pub(in super::super) fn spawn(
            &self,
            command: &mut Command,
            scratch: &Path,
            spawn: impl FnOnce(&mut Command) -> std::io::Result<Child> + Send,
        ) -> std::io::Result<Child> {
            let temporary = scratch.join("tmp");
            std::fs::create_dir_all(&temporary)?;
            command.env("TMPDIR", &temporary);
            let readable = self.grants(command, scratch);
            // A restriction applies permanently to a thread and the processes that it starts, hence a
            // separate thread.
            let restricted = || {
                let mut rules = rules().map_err(std::io::Error::other)?;
                for path in &readable.whole {
                    rules = allow(rules, path, AccessFs::from_read(NEWEST))?;
                }
                // Interpreters list the directory of a program to find its modules.
                for path in &readable.listed {
                    rules = allow(rules, path, AccessFs::ReadDir.into())?;
                }
                for path in DEVICES.map(Path::new).into_iter().chain([temporary.as_path()]) {
                    rules = allow(rules, path, AccessFs::from_all(NEWEST))?;
                }
                let status = rules.restrict_self().map_err(std::io::Error::other)?;
                seccompiler::apply_filter(&without_network()?).map_err(std::io::Error::other)?;
                match status.landlock {
                    LandlockStatus::Available { .. } => spawn(command),
                    _ => Err(std::io::Error::other(MISSING)),
                }
            };
            let ended = || Err(std::io::Error::other("the thread that starts the process panicked"));
            std::thread::scope(|scope| scope.spawn(restricted).join()).unwrap_or_else(|_| ended())
        }

        /// Returns everything that the command may read.
        fn grants(&self, command: &Command, scratch: &Path) -> Readable {
            let mut grants =
                Readable { whole: SYSTEM.iter().map(PathBuf::from).collect(), listed: Vec::new() };
            grants.whole.push(scratch.to_owned());
            grants.whole.extend(self.readable.iter().cloned());
            let search_path = std::env::var_os("PATH").unwrap_or_default();
            for folder in std::env::split_paths(&search_path).filter(|path| path.is_absolute()) {
                self.grant_folder(&prefix(&folder), &mut grants);
            }
            if let Ok(program) = which::which(command.get_program()) {
                self.grant_program(&program, &mut grants);
            }
            for word in std::iter::once(command.get_program()).chain(command.get_args()) {
                let path = Path::new(word);
                match path.parent() {
                    _ if path.is_dir() => self.grant_folder(path, &mut grants),
                    Some(parent) if path.is_file() => {
                        self.grant_folder(
                            if parent == Path::new("") { Path::new(".") } else { parent },
                            &mut grants,
                        );
                    }
                    _ => {}
                }
            }
            match std::env::current_exe().and_then(|program| program.canonicalize()) {
                Ok(own) => without(grants, &own),
                Err(_) => grants,
            }
        }

        /// Grants access to a program and to the installation to which it belongs.
        fn grant_program(&self, program: &Path, grants: &mut Readable) {
            let resolved = program.canonicalize().unwrap_or_else(|_| program.to_owned());
            for path in [program, &resolved] {
                let Some(folder) = path.parent() else { continue };
                self.grant_folder(&prefix(folder), grants);
                grant_base_of_environment(folder, grants);
            }
            if let Some(interpreter) = interpreter_of_script(&resolved) {
                let resolved = interpreter.canonicalize().unwrap_or_else(|_| interpreter.clone());
                for path in [interpreter, resolved] {
                    let Some(folder) = path.parent() else { continue };
                    grant_installation(folder, grants);
                    grant_base_of_environment(folder, grants);
                    grants.whole.push(path);
                }
            }
        }

        /// Grants access to the contents of a directory, except runs and hidden entries.
        fn grant_folder(&self, folder: &Path, grants: &mut Readable) {
            grants.listed.push(folder.to_owned());
            let canonical = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
            let hidden: Vec<PathBuf> = self.hidden.iter().map(|path| canonical(path)).collect();
            for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
                let path = canonical(&entry.path());
                let holds_hidden = hidden.iter().any(|hidden| hidden.starts_with(&path));
                let holds_run = path.join(RUN_FILE).exists()
                    || std::fs::read_dir(&path).is_ok_and(|mut inner| {
                        inner.any(|entry| entry.is_ok_and(|entry| entry.path().join(RUN_FILE).exists()))
                    });
                if !(holds_hidden || holds_run || path.ends_with(RUN_FILE)) {
                    grants.whole.push(path);
                }
            }
        }
    }

    /// Returns the interpreter that the first line of a script names, as in `#!/home/ada/venv/bin/python`.
    fn interpreter_of_script(script: &Path) -> Option<PathBuf> {
        let beginning = read_beginning(script)?;
        let line = beginning.strip_prefix(b"#!")?.split(|byte| *byte == b'\n').next()?;
        let path = std::str::from_utf8(line).ok()?.split_whitespace().next()?;
        Some(PathBuf::from(path)).filter(|path| path.is_absolute())
    }

    /// Grants access to the installation on which a Python environment is based, which its file `pyvenv.cfg`
    /// names: an environment has no standard library of its own.
    fn grant_base_of_environment(programs: &Path, grants: &mut Readable) {
        let settings = programs.parent().map(|environment| environment.join("pyvenv.cfg"));
        let Some(text) = settings.and_then(|path| read_beginning(&path)) else { return };
        let text = String::from_utf8_lossy(&text);
        let mut entries = text.lines().filter_map(|line| line.split_once('='));
        if let Some((_, home)) = entries.find(|(key, _)| key.trim() == "home") {
            grant_installation(Path::new(home.trim()), grants);
        }
    }

    /// Grants access to an installation by the directory of its programs. A script and an environment state
    /// that directory themselves, so only the directories of an installation are granted, and not all that
    /// lies beside them.
    fn grant_installation(programs: &Path, grants: &mut Readable) {
        if !PROGRAMS.iter().any(|name| programs.ends_with(name)) {
            return;
        }
        let resolved = programs.canonicalize().unwrap_or_else(|_| programs.to_owned());
        if let Some(installation) = resolved.parent() {
            grants.whole.extend(INSTALLATION.map(|name| installation.join(name)));
        }
        grants.whole.push(resolved);
    }

    /// Returns the beginning of a regular file.
    fn read_beginning(path: &Path) -> Option<Vec<u8>> {
        let mut beginning = Vec::new();
        let file = std::fs::File::open(path).ok().filter(|_| path.is_file())?;
        file.take(BEGINNING_BYTES).read_to_end(&mut beginning).ok()?;
        Some(beginning)
    }

    /// Paths that a command may read.
    struct Readable {
        /// Paths readable with all their contents.
        whole: Vec<PathBuf>,
        /// Directories of which only the names, including those of subdirectories, are readable.
        listed: Vec<PathBuf>,
    }

    /// Returns what is left of `readable` without a file: the other entries of each directory that contains
    /// it. A program in the sandbox cannot run Boresight to make the frames with their truth.
    fn without(readable: Readable, file: &Path) -> Readable {
        let mut rest = Readable { whole: Vec::new(), listed: readable.listed };
        let mut pending = readable.whole;
        while let Some(path) = pending.pop() {
            let resolved = path.canonicalize().unwrap_or_else(|_| path.clone());
            if resolved == file {
                continue;
            }
            if !file.starts_with(&resolved) {
                rest.whole.push(path);
                continue;
            }
            let entries = std::fs::read_dir(&path).into_iter().flatten().flatten();
            pending.extend(entries.map(|entry| entry.path()));
            rest.listed.push(path);
        }
        rest
    }

    /// Returns a filter that refuses all sockets but those of the file system (`AF_UNIX`), which Landlock
    /// governs, and `io_uring`, which makes sockets without `socket`.
    fn without_network() -> std::io::Result<BpfProgram> {
        let other_than_unix = || {
            let family = libc::AF_UNIX as u64;
            SeccompCondition::new(0, SeccompCmpArgLen::Dword, SeccompCmpOp::Ne, family)
                .and_then(|condition| SeccompRule::new(vec![condition]))
        };
        let filter = || -> Result<BpfProgram, seccompiler::BackendError> {
            let rules =
                [(libc::SYS_socket, vec![other_than_unix()?]), (libc::SYS_io_uring_setup, Vec::new())];
            SeccompFilter::new(
                rules.into_iter().collect(),
                SeccompAction::Allow,
                SeccompAction::Errno(libc::EACCES as u32),
                std::env::consts::ARCH.try_into()?,
            )?
            .try_into()
        };
        filter().map_err(std::io::Error::other)
    }

    /// Newest supported version of the access rights. An older kernel enforces the rights that it supports.
    const NEWEST: ABI = ABI::V6;
    /// Oldest version of the access rights with which a process is started.
    const OLDEST: ABI = ABI::V1;
    const MISSING: &str =
        "the kernel lacks Landlock, which the sandbox requires (Linux 5.13 or later, with Landlock enabled)";

    /// Returns rules that allow nothing: no file, no TCP, no signal to other processes.
    fn rules() -> Result<RulesetCreated, String> {
        let missing = |_| MISSING.to_owned();
        Ruleset::default()
            .set_compatibility(CompatLevel::HardRequirement)
            .handle_access(AccessFs::from_all(OLDEST))
            .map_err(missing)?
            .set_compatibility(CompatLevel::BestEffort)
            .handle_access(AccessFs::from_all(NEWEST))
            .and_then(|rules| rules.handle_access(AccessNet::from_all(NEWEST)))
            .and_then(|rules| rules.scope(Scope::from_all(NEWEST)))
            .and_then(Ruleset::create)
            .map_err(missing)
    }

    /// Allows a path, if it exists.
    fn allow(
        rules: RulesetCreated,
        path: &Path,
        access: landlock::BitFlags<AccessFs>,
    ) -> std::io::Result<RulesetCreated> {
        let Ok(path_fd) = PathFd::new(path) else { return Ok(rules) };
        let access = if path.is_dir() { access } else { access & AccessFs::from_file(NEWEST) };
        rules.add_rule(PathBeneath::new(path_fd, access)).map_err(std::io::Error::other)
    }

    /// Returns the directory that the programs of a directory need: its parent if the directory has a typical
    /// name for programs and the parent is neither a home directory nor the root; else the directory itself.
    fn prefix(programs: &Path) -> PathBuf {
        let is_of_programs = PROGRAMS.iter().any(|name| programs.ends_with(name));
        let home = std::env::home_dir();
        match programs.parent() {
            Some(parent) if is_of_programs && parent != Path::new("/") && Some(parent) != home.as_deref() => {
                parent.to_owned()
            }
            _ => programs.to_owned(),
        }
    }
}

#[cfg(not(target_os = "linux"))]
impl Sandbox {
    /// Checks if the kernel can enforce the sandbox.
    ///
    /// # Errors
    /// Always.
    pub fn check() -> Result<(), String> {
        Err("this system lacks Landlock, which the sandbox requires (Linux 5.13 or later)".to_owned())
    }

    pub(super) fn spawn(
        &self,
        _command: &mut Command,
        _scratch: &Path,
        _spawn: impl FnOnce(&mut Command) -> std::io::Result<Child> + Send,
    ) -> std::io::Result<Child> {
        Err(std::io::ErrorKind::Unsupported.into())
    }
}
