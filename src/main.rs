//! The command `boresight`.

use std::process::ExitCode;

fn main() -> ExitCode {
    boresight::command::main()
}
