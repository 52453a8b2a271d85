#!/usr/bin/env python3
"""Tests golden/verify.py: which results take precedence, and that a failure does not stop later witnesses.

    python3 tests/python/check_verify.py
"""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "golden"))
import verify  # noqa: E402


def agrees(_):
    return "all of it"


def disagrees(_):
    raise AssertionError("differs by 1.0e-03")


def is_not_there(_):
    raise verify.CannotAsk("no such tool")


def breaks(_):
    raise FileNotFoundError("made.csv")


class Results(unittest.TestCase):
    def asked(self, *checks):
        """Exit status and output of a run with these witnesses."""
        witnesses = {f"w{i}": ("a witness", check) for i, check in enumerate(checks)}
        with tempfile.TemporaryDirectory() as work, contextlib.redirect_stdout(io.StringIO()) as said:
            with mock.patch.object(verify, "WITNESSES", witnesses), mock.patch.object(sys, "argv", ["verify.py", "--work", work]):
                return verify.main(), said.getvalue()

    def test_exit_status(self):
        for checks, expected in [
            ([agrees], 0),
            ([agrees, is_not_there], 2),
            ([disagrees, is_not_there], 1),
            ([is_not_there, disagrees], 1),
            ([breaks, agrees, is_not_there], 1),
        ]:
            with self.subTest([check.__name__ for check in checks]):
                self.assertEqual(self.asked(*checks)[0], expected)

    def test_one_that_breaks_does_not_silence_the_next(self):
        status, said = self.asked(breaks, agrees)
        self.assertEqual(status, 1)
        self.assertRegex(said, r"(?m)^NO .* w0 .*made\.csv")
        self.assertRegex(said, r"(?m)^ok .* w1 .*all of it")

    def test_a_command_that_is_not_there_cannot_be_asked(self):
        status, said = self.asked(lambda workspace: workspace.run("no-command-of-this-name"))
        self.assertEqual(status, 2)
        self.assertIn("no-command-of-this-name is not there", said)

    def test_a_command_that_fails_disagrees_and_its_claims_are_told(self):
        script = "print('FAIL places'); print('ok   a'); print('ok   b'); print('ok   c'); raise SystemExit(1)"
        status, said = self.asked(lambda workspace: workspace.run(sys.executable, "-c", script))
        self.assertEqual(status, 1)
        self.assertIn("FAIL places", said)

    def test_a_file_that_was_not_made_is_a_difference(self):
        with tempfile.TemporaryDirectory() as folder:
            committed, made = pathlib.Path(folder, "committed"), pathlib.Path(folder, "made")
            for place in (committed, made):
                place.mkdir()
                (place / "a.csv").write_text("x\n1.0\n")
            (committed / "b.csv").write_text("x\n1.0\n")
            self.assertEqual(verify.compared(committed, made, ["a.csv"]), 0.0)
            with self.assertRaisesRegex(AssertionError, "not made: b.csv"):
                verify.compared(committed, made, ["a.csv", "b.csv"])
            (made / "b.csv").write_text("x\n1.5\n")
            self.assertEqual(verify.compared(committed, made, ["a.csv", "b.csv"]), 0.5)

    def test_words_that_choose_no_test_are_a_mistake(self):
        line = "test result: ok. {} passed; 0 failed; 0 ignored; 0 measured; 7 filtered out; finished in 0.1s\n"
        self.assertEqual(verify.passed(line.format(2) + line.format(3), "planets::"), 5)
        with self.assertRaisesRegex(AssertionError, "no test is chosen by planet::"):
            verify.passed(line.format(0), "planet::")

    def test_the_versions_of_debian_are_printed(self):
        self.assertIn("Debian    astrometry.net ", self.asked(agrees)[1])


if __name__ == "__main__":
    unittest.main()
