"""The commands around a run: help, check, cases, schema, version; and words that are none."""

import json
import re
import subprocess
import tomllib
import unittest

from program import HOLE, MOVING, PLAIN, PROGRAM, ROOT, ProgramTest, replaced

CASES = sorted((ROOT / "cases").rglob("*.toml"), key=lambda path: path.with_suffix(""))
COMMANDS = ["new", "run", "check", "cases", "verify", "compare", "report", "plot", "material", "sweep", "schema", "version", "help"]


def mistakes(schema, value, path=""):
    """What of a JSON value does not fit a JSON Schema, for the keywords that the case format uses."""
    known = {"$schema", "title", "description", "type", "const", "enum", "minLength", "anyOf", "oneOf", "not", "allOf", "if",
             "then", "else", "properties", "required", "additionalProperties", "items", "minItems", "maxItems", "uniqueItems",
             "minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"}
    if schema is True:
        return []
    if schema is False:
        return [f"{path}: not allowed"]
    if unknown := set(schema) - known:
        raise ValueError(f"the checker does not know {unknown}")
    found = []

    def fits(part):
        return not mistakes(part, value, path)

    def expect(condition, text):
        if not condition:
            found.append(f"{path}: {text}")

    types = {"string": str, "boolean": bool, "integer": int, "number": (int, float), "object": dict, "array": list}
    if "type" in schema:
        names = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        if not isinstance(value, tuple(t for name in names for t in (types[name] if name == "number" else (types[name],)))):
            return [f"{path}: is no {names}"]
    expect("const" not in schema or value == schema["const"], "is not the constant")
    expect("enum" not in schema or value in schema["enum"], f"{value} is none of {schema.get('enum')}")
    expect("anyOf" not in schema or any(map(fits, schema["anyOf"])), "fits none")
    expect("oneOf" not in schema or sum(map(fits, schema["oneOf"])) == 1, "does not fit exactly one")
    expect("not" not in schema or not fits(schema["not"]), "fits what it must not")
    for part in schema.get("allOf", []):
        found += mistakes(part, value, path)
    if "if" in schema:
        found += mistakes(schema.get("then" if fits(schema["if"]) else "else", True), value, path)
    if isinstance(value, str):
        expect(len(value) >= schema.get("minLength", 0), "is too short")
    if isinstance(value, (int, float)):
        expect(value >= schema.get("minimum", value), "is too small")
        expect(value <= schema.get("maximum", value), "is too large")
        expect("exclusiveMinimum" not in schema or value > schema["exclusiveMinimum"], "is too small")
        expect("exclusiveMaximum" not in schema or value < schema["exclusiveMaximum"], "is too large")
    if isinstance(value, list):
        expect(schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)), "has the wrong length")
        expect(not schema.get("uniqueItems") or len(set(map(str, value))) == len(value), "repeats itself")
        for number, item in enumerate(value):
            found += mistakes(schema.get("items", True), item, f"{path}.{number}")
    if isinstance(value, dict):
        for key in schema.get("required", []):
            expect(key in value, f"{key} is missing")
        for key, item in value.items():
            part = schema.get("properties", {}).get(key, schema.get("additionalProperties", True))
            found += mistakes(part, item, f"{path}.{key}")
    return found


class Schema(ProgramTest):
    def test_shipped_cases_fit_it(self):
        schema = json.loads(self.command("schema").stdout)
        self.assertGreaterEqual(len(CASES), 4)
        for path in CASES + sorted((ROOT / "src/app/starters").glob("*.toml")):
            self.assertEqual(mistakes(schema, tomllib.loads(path.read_text(encoding="utf-8"))), [], path)
        for text in (PLAIN, HOLE, MOVING):
            self.assertEqual(mistakes(schema, tomllib.loads(text)), [])

    def test_wrong_cases_do_not(self):
        schema = json.loads(self.command("schema").stdout)
        for old, new in [("title =", "titel ="), ("[solver]", "[slover]"), ("horizon", "horizn"), ("neo-hookean", "neo"),
                         ('"6 MPa"', "6"), ("stretch = [1.2, 1.4]", ""), ("stretch = [1.2, 1.4]", 'until = "1 s"'),
                         ("points = [20, 20]", 'points = [20, 20], spacing = "1 mm"'), ("[1.2, 1.4]", "[]")]:
            self.assertNotEqual(mistakes(schema, tomllib.loads(replaced(PLAIN, old, new))), [], new)

    def test_the_reference_page_is_up_to_date(self):
        self.assertEqual(self.command("schema", "--markdown").stdout,
                         (ROOT / "docs/reference.md").read_text(encoding="utf-8"),
                         "write it anew: riven schema --markdown > docs/reference.md")


class Check(ProgramTest):
    def value(self, text, pattern):
        found = re.search(pattern, text, re.MULTILINE)
        self.assertIsNotNone(found, f"{pattern} in\n{text}")
        return float(found[1])

    def test_what_a_case_means(self):
        case = self.write("hole.toml", HOLE + '\n[set.corner]\nwhere = "x > 80 mm && y > 80 mm"\n')
        text = self.command("check", case).stdout
        self.assertEqual(self.value(text, r"^# set corner: (\d+) points, x 0.085 to 0.095 m, y 0.085 to 0.095 m$"), 4)
        points = self.value(text, r"^# body: (\d+) points")
        self.assertAlmostEqual(points, 400 - 3.14159 * 9, delta=8)
        self.assertAlmostEqual(self.value(text, r"volume ([\d.e-]+) m\^3"), (0.04 - 3.14159 * 0.0009) * 0.01, delta=1e-9)
        self.assertEqual(self.value(text, r"shear modulus ([\d.e+]+) Pa"), 2e6)
        self.assertEqual(self.value(text, r", (\d+) neighbours within the horizon"), 28)
        self.assertGreater(self.value(text, r"^# time: about ([\d.e+-]+) s on \d+ threads"), 0)
        # 20 points along a side, one small load step and two of 0.1 to each of the two states.
        self.assertEqual(self.value(text, r"\((\d+) force evaluations"), 3.5 * 20 * 5)
        memory = self.value(text, r"^# memory: about (\d+) MB$")
        self.assertGreater(memory, 5)
        self.assertLess(memory, 100)
        self.assertEqual(re.findall(r"^# metric (.*)$", text, re.MULTILINE), ["force_x [N]", "force_y [N]", "hole_x"])
        self.assertEqual(self.everything(), ["hole.toml"])

    def test_what_it_prints_is_a_case(self):
        for name, text in {"hole": HOLE, "moving": MOVING}.items():
            printed = self.command("check", self.write(f"{name}.toml", text)).stdout
            again = self.command("check", self.write("again.toml", printed)).stdout
            keep = [line for line in printed.splitlines() if not line.startswith("# time")]
            self.assertEqual([line for line in again.splitlines() if not line.startswith("# time")], keep)

    def test_time_of_a_run_in_time(self):
        case = self.write("moving.toml", MOVING)
        text = self.command("check", case).stdout
        limit = self.value(text, r"^# stable step of explicit methods: ([\d.e-]+) s at rest$")
        steps = self.value(text, r"\(([\d.e+]+) force evaluations")
        self.assertAlmostEqual(steps * 0.8 * limit / 4e-3, 1, delta=0.02)
        self.command("run", case)
        # The body stiffens as it deforms: measured 1.1 times the steps that were estimated at rest.
        self.assertAlmostEqual(self.summary("results/moving")["timing"]["steps"] / steps, 1, delta=0.4)

    def test_warnings(self):
        text = replaced(replaced(PLAIN, '"3 dx"', '"2 dx"'), '\n[[probe]]\nname = "force"\nkind = "reaction"\non = "right"\n', "")
        warnings = re.findall(r"^# warning: (.*)$", self.command("check", self.write("case.toml", text)).stdout, re.MULTILINE)
        self.assertEqual([warning.split(":")[0] for warning in warnings], ["the horizon is 2 spacings", "there is no probe"])
        self.assertNotIn("# warning", self.command("check", self.write("case.toml", PLAIN)).stdout)

    def test_every_shipped_case(self):
        for path in CASES:
            self.command("check", path)


class Words(ProgramTest):
    def test_help(self):
        for words in (["help"], ["--help"], ["-h"]):
            text = self.command(*words).stdout
            for command in COMMANDS:
                self.assertRegex(text, rf"(?m)^  {command} +\S")
        nothing = self.command(expect=2)
        self.assertEqual((nothing.stdout, nothing.stderr), ("", text))
        for command in COMMANDS:
            self.assertEqual(self.command("help", command).stdout, self.command(command, "--help").stdout)

    def test_version(self):
        version = re.search(r"project\(riven VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        for word in ("version", "--version"):
            self.assertEqual(self.command(word).stdout, f"riven {version}\n")

    def test_cases(self):
        text = self.command("cases").stdout
        names = re.findall(r"^  (\S+)  +\S", text, re.MULTILINE)
        self.assertEqual(names, [str(path.relative_to(ROOT / "cases").with_suffix("")) for path in CASES])
        for path in CASES:
            self.assertIn(tomllib.loads(path.read_text(encoding="utf-8"))["title"], text)

    def test_words_that_are_none(self):
        for words, message in {
                ("rnu",): f'rnu: unknown command; expected one of {", ".join(COMMANDS)}; did you mean "run"?',
                ("sheet.toml",): 'did you mean "riven run sheet.toml"?',
                ("help", "rnu"): 'did you mean "run"?',
                ("run",): 'case is required; "riven run --help" shows what is expected',
                ("run", "a", "b"): "b: one argument too many",
                ("run", "a", "--thread", "2"): '--thread: unknown option; did you mean "--threads"?',
                ("run", "a", "--threads", "0"): "--threads: Value 0 not in range 1 to 1024",
                ("run", "a", "--threads", "-1"): "--threads",
                ("run", "a", "--threads", "two"): "--threads",
                ("run", "a", "--set"): "--set",
                ("run", "a", "-o"): "--output",
                ("compare", "a"): "reference is required",
                ("verify", "neo-hookean-membrane/equibiaxial-hol"): 'did you mean "neo-hookean-membrane/equibiaxial-hole"?',
                ("run", "neo-hookean-membrane/equibiaxial-hol"): 'did you mean "neo-hookean-membrane/equibiaxial-hole"?',
                ("check", "nothing.toml"): "nothing.toml: no such file; expected a case file in TOML",
                ("run", "x/" + "y" * 300): "",
                ("--verbose",): "riven --help"}.items():
            with self.subTest(" ".join(words)):
                self.assertIn(message, self.refused(*words))

    def test_an_output_that_goes_nowhere(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            for words in (["version"], ["schema"], ["cases"]):
                done = subprocess.run([PROGRAM, *words], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
                self.assertEqual(done.returncode, 3)
                self.assertIn("No space left on device", done.stderr)


if __name__ == "__main__":
    unittest.main()
