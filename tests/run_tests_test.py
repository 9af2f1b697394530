"""run_tests.py: reasons of skips as ctest reports them, and which skips fail where CI is set."""
import contextlib
import io
import pathlib
import re
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools"))
import run_tests  # noqa: E402

JUNIT = """<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="(empty)" tests="5" failures="0" disabled="1" skipped="3" hostname="" time="1">
  <testcase name="a.Passes" classname="a.Passes" time="0.1" status="run"><system-out>[       OK ]</system-out></testcase>
  <testcase name="b.Data" classname="b.Data" time="0.1" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
    <system-out>[ RUN      ] B.Data
b_test.cpp:12: Skipped
no ../shared/data beside the checkout

[  SKIPPED ] B.Data (0 ms)</system-out></testcase>
  <testcase name="c.Silent" classname="c.Silent" time="0.1" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
    <system-out>c_test.cpp:3: Skipped

[  SKIPPED ] C.Silent (0 ms)</system-out></testcase>
  <testcase name="format" classname="format" time="0.1" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>
    <system-out>skipped: clang-format 14 is not installed
</system-out></testcase>
  <testcase name="d.DISABLED_Off" classname="d" time="0" status="disabled"><disabled message="Disabled"/></testcase>
</testsuite>
"""


class RunTests(unittest.TestCase):
    def test_finds_every_skip_with_its_reason(self):
        with tempfile.TemporaryDirectory() as folder:
            junit_file = pathlib.Path(folder) / "tests.xml"
            junit_file.write_text(JUNIT, encoding="utf-8")
            self.assertEqual([("b.Data", "no ../shared/data beside the checkout"),
                              ("c.Silent", "no reason given"),
                              ("format", "clang-format 14 is not installed"),
                              ("d.DISABLED_Off", "disabled in the source")], run_tests.skips_in(junit_file))

    def test_a_skip_nobody_named_fails_where_strict(self):
        skips = [("b.Data", "no ../shared/data")]
        named, other = [re.compile(r"\.\./shared")], [re.compile("^c")]
        with contextlib.redirect_stdout(io.StringIO()) as output:
            self.assertTrue(run_tests.report(skips, named, strict=True))
            self.assertTrue(run_tests.report(skips, other, strict=False))
            self.assertFalse(run_tests.report(skips, other, strict=True))
            self.assertTrue(run_tests.report([], other, strict=True))
        self.assertEqual(3, output.getvalue().count("b.Data: no ../shared/data"))

    def test_the_shipped_list_of_allowed_skips_compiles(self):
        patterns = run_tests.allowed_skips(run_tests.ROOT / "tests" / "allowed_skips")
        self.assertFalse(any(pattern.search("any.Test: any reason") for pattern in patterns))


if __name__ == "__main__":
    unittest.main()
