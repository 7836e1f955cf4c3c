"""The wrapper `riven` on a toy project: builds when needed, starts fast, says what is missing."""

import os
import pathlib
import shutil
import stat
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

CMAKE_LISTS = """
cmake_minimum_required(VERSION 3.25)
project(toy LANGUAGES CXX)
add_executable(riven src/main.cpp)
if(RIVEN_TESTS)
  enable_testing()
  add_test(NAME toy COMMAND riven passes)
  add_test(NAME toy2 COMMAND riven fails)
endif()
"""

MAIN = """
#include <cstdio>
#include <cstring>
int main(int n, char** words) {
  for (int i = 1; i < n; ++i) std::printf("[%s]", words[i]);
  return n > 1 && std::strcmp(words[1], "fails") == 0 ? 7 : 0;
}
"""

# Stands for `id`, `sudo`, `apt-get` of a machine where the user is $TOY_USER and apt-get notes what it was asked.
STUBS = {
    "id": 'echo "$TOY_USER"',
    "sudo": "exit 1",
    "apt-get": 'echo "apt-get $*" >>"$TOY_NOTES"; [ "$1" = update ] || exit 100',
}


def write_program(path, text):
    path.write_text("#!/bin/sh\n" + text + "\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


class Wrapper(unittest.TestCase):
    def setUp(self):
        # A blank in the path, as users have them.
        folder = tempfile.TemporaryDirectory(prefix="riven toy ")
        self.addCleanup(folder.cleanup)
        self.top = pathlib.Path(folder.name)
        self.toy = self.top / "toy"
        (self.toy / "src").mkdir(parents=True)
        (self.toy / "cmake").mkdir()
        (self.toy / "web/dist").mkdir(parents=True)
        shutil.copy(ROOT / "riven", self.toy)
        shutil.copy(ROOT / "CMakePresets.json", self.toy)
        (self.toy / "packages.txt").write_text("# comment\nbuild: dpkg\n")
        (self.toy / "CMakeLists.txt").write_text(CMAKE_LISTS)
        (self.toy / "src/main.cpp").write_text(MAIN)

    def riven(self, *words, program=None, **environment):
        return subprocess.run(
            [program or self.toy / "riven", *words], cwd=self.top, env={**os.environ, **environment},
            capture_output=True, text=True, timeout=120, check=False)

    def with_stubs(self, user):
        stubs = self.top / "stubs"
        stubs.mkdir()
        for name, text in STUBS.items():
            write_program(stubs / name, text)
        return {"PATH": f"{stubs}:{os.environ['PATH']}", "TOY_USER": user, "TOY_NOTES": str(self.top / "notes")}

    def test_builds_once_then_starts_at_once(self):
        first = self.riven("one", "two words", "")
        self.assertEqual((first.returncode, first.stdout), (0, "[one][two words][]"), first.stderr)
        self.assertEqual(first.stderr, "riven: building Riven (first use)...\n")
        link = self.top / "link"
        link.symlink_to(self.toy / "riven")
        start = time.monotonic()
        second = self.riven("fails", program=link)
        self.assertLess(time.monotonic() - start, 1.0)  # measured 0.03 s; what a user does not notice
        self.assertEqual((second.returncode, second.stdout, second.stderr), (7, "[fails]", ""))

    def test_builds_again_after_a_change_and_shows_errors(self):
        self.riven()
        (self.toy / "src/main.cpp").write_text("int main() { return 5; }")
        changed = self.riven()
        self.assertEqual(changed.returncode, 5)
        self.assertEqual(changed.stderr, "riven: building Riven (sources changed)...\n")
        (self.toy / "src/main.cpp").write_text("int main() { return nonsense; }")
        for _ in range(2):
            broken = self.riven()
            self.assertEqual((broken.returncode, broken.stdout), (3, ""))
            self.assertIn("nonsense", broken.stderr)

    def test_a_moved_checkout_is_built_anew(self):
        self.riven()
        moved = self.top / "moved"
        self.toy.rename(moved)
        run = self.riven("x", program=moved / "riven")
        self.assertEqual((run.returncode, run.stdout), (0, "[x]"), run.stderr)
        self.assertIn("other folder", run.stderr)

    def test_two_first_calls_build_once(self):
        calls = [subprocess.Popen([self.toy / "riven", "x"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  text=True) for _ in range(2)]
        outputs = [call.communicate(timeout=120) for call in calls]
        self.assertEqual([out for out, _ in outputs], ["[x]", "[x]"], outputs)
        self.assertEqual(sum("building" in err for _, err in outputs), 1, outputs)

    def test_runs_tests_with_their_status_and_options(self):
        (self.toy / "packages.txt").write_text("build: dpkg\ntest: tar\n")
        failed = self.riven("test")
        self.assertNotEqual(failed.returncode, 0)
        self.assertIn("1 tests failed out of 2", failed.stdout)
        passed = self.riven("test", "-R", "toy$")
        self.assertEqual(passed.returncode, 0, passed.stderr)
        self.assertTrue(passed.stdout.rstrip().splitlines()[-1].startswith("Total Test time"), passed.stdout)

    def test_brings_the_packages_of_the_report_page_once(self):
        (self.toy / "web/package-lock.json").write_text("{}")
        stubs = self.with_stubs(user="0")
        write_program(self.top / "stubs/npm", 'echo "npm $*" >>"$TOY_NOTES"; mkdir -p "$3/node_modules"; '
                                              'touch "$3/node_modules/.package-lock.json"')
        for _ in range(2):
            self.assertIn("Total Test time", self.riven("test", "-R", "toy$", **stubs).stdout)
        self.assertEqual((self.top / "notes").read_text(),
                         f"npm ci --prefix {self.toy}/web --no-audit --no-fund\n")

    def test_without_root_names_the_missing_packages(self):
        (self.toy / "packages.txt").write_text("build: dpkg riven-no-such-b\nbuild: riven-no-such-a\ntest: riven-t\n")
        stubs = self.with_stubs(user="1000")
        run = self.riven("version", **stubs)
        self.assertEqual((run.returncode, run.stdout), (2, ""))
        self.assertTrue(run.stderr.endswith(
            "  sudo apt-get install --no-install-recommends riven-no-such-a riven-no-such-b\n"), run.stderr)
        self.assertIn("riven-no-such-b riven-t\n", self.riven("test", **stubs).stderr)
        self.assertFalse((self.top / "notes").exists())

    def test_as_root_installs_the_missing_packages_only(self):
        (self.toy / "packages.txt").write_text("build: dpkg riven-no-such\n")
        run = self.riven("version", **self.with_stubs(user="0"))
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertIn("could not install riven-no-such", run.stderr)
        update, install = (self.top / "notes").read_text().splitlines()
        self.assertEqual(update, "apt-get update")
        self.assertRegex(install, r"^apt-get install -y .* riven-no-such$")
        self.assertNotIn("dpkg ", install)


if __name__ == "__main__":
    unittest.main()
