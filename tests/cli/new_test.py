"""`riven new`: cases to start from."""

import pathlib
import re
import unittest

from program import PROGRAM, ROOT, ProgramTest

STARTERS = ROOT / "src/app/starters"
KINDS = sorted(path.stem for path in STARTERS.glob("*.toml"))


def uncommented(text):
    """A starter with the sections that it offers in comments."""
    return re.sub(r"(?m)^# (\[\[\w+\]\].*\n(?:# \w+ = .*\n)+)", lambda found: found[1].replace("\n# ", "\n"), text)


class New(ProgramTest):
    def test_the_kinds_are_listed(self):
        lines = self.command("new", "--list").stdout.splitlines()
        self.assertEqual([line.split()[0] for line in lines], KINDS)
        self.assertLessEqual({"membrane", "membrane-dynamic", "table"}, set(KINDS))
        for line in lines:
            self.assertGreater(len(line.split(maxsplit=1)[1]), 20)
        self.assertEqual(self.everything(), [])

    def test_each_kind_runs_as_it_is(self):
        for kind in KINDS:
            with self.subTest(kind):
                folder = self.top / kind
                folder.mkdir()
                said = self.command("new", "--kind", kind, cwd=folder).stdout
                names = [kind + ".toml"] + [path.name.removeprefix(kind + ".") for path in STARTERS.glob(kind + ".*")
                                            if path.suffix != ".toml"]
                self.assertEqual(sorted(path.name for path in folder.iterdir()), sorted(names))
                for name in names:
                    self.assertIn(f"wrote {name}\n", said)
                text = (folder / f"{kind}.toml").read_text(encoding="utf-8")
                self.assertEqual(text, (STARTERS / f"{kind}.toml").read_text(encoding="utf-8"))
                steps = re.findall(r"(?m)^  riven (\w+) (\S+) ", said)
                self.assertEqual(steps, [("check", f"{kind}.toml"), ("run", f"{kind}.toml")])
                for step in steps:
                    done = self.command(*step, cwd=folder)
                    self.assertNotIn("warning", done.stdout + done.stderr)
                self.assertIn(f"results in results/{kind}:", said)
                self.assertEqual(self.summary(folder / "results" / kind)["status"], "finished")
                self.assertLess(self.summary(folder / "results" / kind)["timing"]["wall_s"], 10)

    def test_what_stands_in_comments_is_right_too(self):
        self.command("new", "sheet.toml")
        text = (self.top / "sheet.toml").read_text(encoding="utf-8")
        for section in ("crack", "inclusion", "expect"):
            self.assertIn(f"\n[[{section}]]", uncommented(text))
        # The expectation is that of the sheet as it is.
        expected = re.search(r"(?m)^# (\[\[expect\]\]\n(?:# .*\n?)+)", text)[1].replace("\n# ", "\n")
        self.write("expected.toml", text + expected)
        self.assertRegex(self.command("verify", "expected.toml").stdout, r"force \[N\] .* ok\n")
        self.command("check", self.write("all.toml", uncommented(text)))
        self.command("run", "all.toml")
        for kind, on in {"membrane-dynamic": "load.2", "table": "load.2"}.items():
            self.command("new", "--kind", kind, f"{kind}.toml")
            comments = re.findall(r'(?m)^#.*', (self.top / f"{kind}.toml").read_text(encoding="utf-8"))
            formulas = [f for line in comments for f in re.findall(r'"([^"]*\bt\b[^"]*)"', line)
                        if not f.startswith(("shape", "riven")) and not (kind != "table" and "pull" in f)]
            self.assertGreaterEqual(len(formulas), 2)
            for formula in formulas:
                hold = ["--set", "table.pull.outside=hold"] if kind == "table" else []
                self.command("check", f"{kind}.toml", "--set", f'{on}.displacement=["{formula}", 0]', *hold)

    def test_names(self):
        for name, path in {"sheet": "sheet.toml", "sheet.v2": "sheet.v2.toml", "my sheet.toml": "my sheet.toml"}.items():
            self.assertIn(f"wrote {path}\n", self.command("new", name).stdout)
            self.assertTrue((self.top / path).is_file())
        self.assertIn("riven run 'my sheet.toml' ", self.command("new", "my sheet.toml", "--force").stdout)
        (self.top / "cases").mkdir()
        self.command("new", "cases/strip.toml", "--kind", "table")
        self.command("check", "cases/strip.toml")

    def test_nothing_is_replaced_unasked(self):
        self.write("sheet.toml", "mine")
        self.assertIn("sheet.toml: exists already; expected a new name, or --force", self.refused("new", "sheet.toml"))
        self.assertEqual((self.top / "sheet.toml").read_text(), "mine")
        self.command("new", "sheet.toml", "--force")
        self.assertNotEqual((self.top / "sheet.toml").read_text(), "mine")
        self.write("pull.csv", "mine")
        self.assertIn("pull.csv: exists already", self.refused("new", "strip.toml", "--kind", "table"))
        self.assertEqual((self.top / "pull.csv").read_text(), "mine")

    def test_wrong_words(self):
        (self.top / "folder").mkdir()
        for words, message in {
                ("--kind", "membran"): "--kind membran: unknown; expected one of "
                                       + ", ".join(KINDS) + '; did you mean "membrane"?',
                ("--kind", "x"): "expected one of " + ", ".join(KINDS),
                ("folder",): "folder: is a folder; expected the name of a file to write, such as folder/membrane.toml",
                ("nowhere/sheet.toml",): "there is no folder nowhere",
                ("a.toml", "b.toml"): "b.toml: one argument too many",
                ("--knd", "table"): 'did you mean "--kind"?'}.items():
            with self.subTest(" ".join(words)):
                self.assertIn(message, self.refused("new", *words))

    def test_the_program_holds_them(self):
        program = pathlib.Path(PROGRAM).read_bytes()
        for path in STARTERS.iterdir():
            self.assertIn(path.read_bytes(), program, path)


if __name__ == "__main__":
    unittest.main()
