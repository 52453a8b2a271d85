//! Output on stdout and stderr: a table for a user, or one JSON document.
use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::time::Duration;

use files::Failure;
use indicatif::{ProgressBar, ProgressStyle};
use pipeline::external::protocol::{harmless, is_invisible};
use run::FirstFailure;
use serde::Serialize;

/// Output to stdout and stderr; stdout is reserved for JSON with `--json`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Output {
    json: bool,
}

impl Output {
    pub(super) fn new(json: bool) -> Self {
        Self { json }
    }

    /// Prints `document` as JSON, or `text` for a user.
    pub(super) fn answer(&self, document: &impl Serialize, text: impl Display) -> Result<(), Failure> {
        if self.json {
            let json = serde_json::to_string_pretty(document)
                .map_err(|error| Failure::Usage(format!("the output cannot be written as JSON: {error}")))?;
            print_json(&json)
        } else {
            print_line(harmless_but_styled(&text.to_string()))
        }
    }

    /// Prints a document that is already JSON, or `text` for a user.
    pub(super) fn answer_json(&self, json: &str, text: impl Display) -> Result<(), Failure> {
        if self.json { print_json(json) } else { print_line(harmless_but_styled(&text.to_string())) }
    }

    /// Prints `document` if `--json` is given; for a command that has no other output on stdout.
    #[cfg_attr(
        not(feature = "monitor"),
        expect(dead_code, reason = "only the monitor writes output while it runs")
    )]
    pub(super) fn document(&self, document: &impl Serialize) -> Result<(), Failure> {
        if self.json { self.answer(document, "") } else { Ok(()) }
    }

    /// Rejects an argument that needs stdout if `--json` is given.
    pub(super) fn check_free(&self, argument: &str) -> Result<(), Failure> {
        if self.json {
            return Err(Failure::Usage(format!("{argument} conflicts with --json: both write to stdout")));
        }
        Ok(())
    }

    /// Prints a remark on stderr.
    pub(super) fn note(&self, text: impl Display) {
        // A closed stderr cannot be reported.
        let _ = writeln!(std::io::stderr(), "{}", harmless(&text.to_string()));
    }

    /// Prints warnings about input that is valid but probably unintended.
    pub(super) fn warn(&self, warnings: &[String]) {
        warnings.iter().for_each(|warning| self.note(format!("warning: {warning}")));
    }

    /// Reports a pipeline that failed, to distinguish a program that never started from one with poor
    /// results.
    pub(super) fn first_failure(&self, failure: Option<&FirstFailure>) {
        if let Some(FirstFailure { frame, reason }) = failure {
            self.note(format!("the pipeline failed, first at frame {frame}: {reason}"));
        }
    }

    /// Reports a failure: on stderr with the location of the mistake, and with `--json` on stdout too.
    pub(super) fn failure(&self, failure: Failure) {
        if self.json {
            let document = serde_json::json!({ "error": failure.to_string() });
            let _ = print_json(&document.to_string());
        }
        self.note(failure.explain());
    }

    /// With `--json`, reports invalid arguments on stdout; clap itself reports them on stderr. A request for
    /// help or for the version is not an error.
    pub(super) fn misuse(&self, error: &clap::Error) {
        if self.json && error.use_stderr() {
            let text = error.to_string();
            let document =
                serde_json::json!({ "error": text.strip_prefix("error: ").unwrap_or(&text).trim_end() });
            let _ = print_json(&document.to_string());
        }
    }

    /// Returns a progress bar over `frames` on stderr; hidden if stderr is not a terminal.
    pub(super) fn progress(&self, frames: u64, what: &str) -> ProgressBar {
        self.progress_of(frames, "frames", what)
    }

    /// Returns a progress bar over `count` units.
    pub(super) fn progress_of(&self, count: u64, unit: &str, what: &str) -> ProgressBar {
        if !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let style = &format!("{{msg}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{per_sec}}, {{eta}} left");
        let bar = ProgressBar::new(count).with_message(harmless(what));
        bar.enable_steady_tick(Duration::from_millis(200));
        match ProgressStyle::with_template(style) {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        }
    }

    /// Returns a counter of fields on stderr, for an unknown total; hidden if stderr is not a terminal.
    pub(super) fn counter(&self, what: &str) -> ProgressBar {
        if !std::io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let bar = ProgressBar::no_length().with_message(harmless(what));
        bar.enable_steady_tick(Duration::from_millis(200));
        match ProgressStyle::with_template("{msg} {pos} fields, {per_sec}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        }
    }

    /// Returns true if stdout is a terminal.
    pub(super) fn is_terminal(&self) -> bool {
        std::io::stdout().is_terminal()
    }
}

/// Returns a text whose only terminal control sequences are text styles: names and reasons in it may come
/// from any source.
fn harmless_but_styled(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("\u{1b}[") {
        let orders = after.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';');
        let numbers = after.strip_suffix(orders).unwrap_or_default();
        shown += &harmless(before);
        (shown, rest) = match orders.strip_prefix('m') {
            Some(plain) => (shown + "\u{1b}[" + numbers + "m", plain),
            None => (shown + &harmless("\u{1b}") + "[", after),
        };
    }
    shown + &harmless(rest)
}

/// Prints JSON without terminal control characters and without invisible ones. JSON itself only escapes the
/// control characters below U+0020, and not DEL or the characters from U+0080 on, of which U+009B begins a
/// control sequence as ESC does.
fn print_json(json: &str) -> Result<(), Failure> {
    print_line(harmless_json(json))
}

fn harmless_json(json: &str) -> String {
    let mut shown = String::with_capacity(json.len());
    for character in json.chars() {
        match character {
            '\u{7f}'..='\u{9f}' => shown += &escaped_json(character),
            _ if is_invisible(character) => shown += &escaped_json(character),
            _ => shown.push(character),
        }
    }
    shown
}

/// Returns the escape sequence of a character in JSON, a pair of surrogates beyond U+FFFF.
fn escaped_json(character: char) -> String {
    character.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")).collect()
}

/// Prints one line; a reader that has closed the pipe (`| head`) is not an error.
fn print_line(text: impl Display) -> Result<(), Failure> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Usage(format!("stdout cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escaped_json_has_the_same_meaning_and_no_control_characters() {
        let document =
            serde_json::json!({ "day\u{9b}2J": "ä\u{7f}\u{80}\u{9f}\u{a0}\u{1b}", "b": "\u{202e}\u{e0001}" });
        let shown = harmless_json(&serde_json::to_string_pretty(&document).unwrap());
        assert!(!shown.chars().any(|character| character.is_control() && character != '\n'), "{shown:?}");
        assert!(shown.contains("\\u202e\\udb40\\udc01"), "{shown}");
        assert!(shown.contains("ä\\u007f\\u0080\\u009f\u{a0}\\u001b"), "{shown}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&shown).unwrap(), document);
    }

    #[test]
    fn a_terminal_receives_only_letter_styles() {
        assert_eq!(harmless_but_styled("\u{1b}[1;31mday\u{1b}[0m 1\tä\n"), "\u{1b}[1;31mday\u{1b}[0m 1\tä\n");
        assert_eq!(
            harmless_but_styled("\u{1b}[2J\u{1b}]0;x\u{7}\u{1b}["),
            "\\u{1b}[2J\\u{1b}]0;x\\u{7}\\u{1b}["
        );
    }
}
