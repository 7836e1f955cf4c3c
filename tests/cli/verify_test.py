"""`riven verify`: what it compares, what decides, and its exit codes."""

import base64
import html.parser
import re
import unittest
import xml.etree.ElementTree as ElementTree

from program import PLAIN, ProgramTest, plain_force, replaced

FORCE = """
[[expect]]
metric = "force_x"
value = "{value:.9g} N"
tolerance = "0.1 %"
at = {at}
kind = "reference"
source = "analytic"
"""
PUBLISHED = """
[[expect]]
metric = "force_x"
value = "{value:.9g} N"
tolerance = "1 %"
kind = "published"
"""
MET = PLAIN + FORCE.format(value=plain_force(1.2), at=1.2) + FORCE.format(value=plain_force(1.4) / 1.0005, at=1.4)
MISSED = PLAIN + FORCE.format(value=plain_force(1.4) / 1.02, at=1.4)
SHORT = MISSED + """
[short]
set = ["solver.stretch=[1.1]", "geometry.box.points=[10, 10]"]

[[short.expect]]
metric = "force_x"
value = "{:.9g} N"
tolerance = "0.1 %"
kind = "reference"
""".format(plain_force(1.1))


class Page(html.parser.HTMLParser):
    """A well-formed HTML page as a tree."""

    def __init__(self):
        super().__init__()
        self.builder = ElementTree.TreeBuilder()

    @classmethod
    def read(cls, text):
        page = cls()
        page.feed(text)
        return page.builder.close()

    def handle_starttag(self, tag, attrs):
        self.builder.start(tag, {key: value or "" for key, value in attrs})
        if tag in ("meta", "img"):
            self.builder.end(tag)

    def handle_endtag(self, tag):
        self.builder.end(tag)

    def handle_data(self, data):
        self.builder.data(data)


class Verify(ProgramTest):
    def rows(self, text):
        """The table's rows as lists of cells; the columns must stand under their names."""
        lines = text.splitlines()
        start = next(i for i, line in enumerate(lines) if line.startswith("  metric"))
        table = []
        for line in lines[start + 1:]:
            if not line.startswith("  "):
                break
            table.append(line)
        ends = [lines[start].index(name) + len(name) for name in ("at", "published", "reference", "ours", "deviation",
                                                                  "limit")]
        for line in table:
            for end in ends:  # right-aligned: a cell or nothing ends there, and a gap follows
                self.assertEqual(line[end:end + 2].strip(), "", f"{lines[start]}\n{line}")
        return [re.split(r"  +", line.strip()) for line in table]

    def test_met(self):
        done = self.command("verify", self.write("met.toml", MET))
        rows = self.rows(done.stdout)
        ours = [f"{plain_force(stretch):.6g}" for stretch in (1.2, 1.4)]
        self.assertEqual(rows[0][:4], ["force_x [N]", "1.2", ours[0], ours[0]])
        self.assertEqual(rows[0][-2:], ["0.1 %", "ok"])
        self.assertEqual(rows[1][1], "1.4")
        self.assertEqual(rows[1][-3:], ["0.05 %", "0.1 %", "ok"])
        self.assertEqual(done.stdout.splitlines()[0], "met: Sheet")
        self.assertEqual(done.stdout.splitlines()[-1], "1 of 1 cases meet their references, 0 missed, 0 failed")
        self.assertEqual(self.summary("results/met")["status"], "finished")

    def test_rounding_is_no_deviation(self):
        case = self.write("met.toml", PLAIN + FORCE.format(value=plain_force(1.4), at=1.4) + '\n[[expect]]\nmetric = '
                          '"force_y"\nvalue = 0\nabsolute_tolerance = "1 mN"\nkind = "reference"\n')
        self.command("verify", case)
        text = replaced(PLAIN, "[1.2, 1.4]", "[1.4]") + '\n[[expect]]\nfield = "displacement"\nfile = "p.csv"\n' \
            'tolerance = 0.01\nkind = "reference"\n'
        self.write("p.csv", "X_m,Y_m,ux_m,uy_m\n0.03,0.05,0.012,0.02\n-0.01,0.02,-0.004,0.008\n")
        row, = self.rows(self.command("verify", self.write("field.toml", text)).stdout)
        self.assertEqual(row, ["displacement field", "1.4", "0 %", "1 %", "ok"])

    def test_missed(self):
        done = self.command("verify", self.write("missed.toml", MISSED), expect=1)
        row, = self.rows(done.stdout)
        self.assertEqual(row[-3:], ["2 %", "0.1 %", "MISSED"])
        self.assertEqual(done.stdout.splitlines()[-1], "0 of 1 cases meet their references, 1 missed, 0 failed")

    def test_ranges_decide(self):
        for limits, code in {'min = "1 N"': 0, 'max = "1 N"': 1, 'min = "1 N"\nmax = "1000 MN"': 0}.items():
            text = PLAIN + f'\n[[expect]]\nmetric = "force_x"\n{limits}\nkind = "reference"\n'
            self.command("verify", self.write("range.toml", text), expect=code)

    def test_published_values_are_reported_only(self):
        done = self.command("verify", self.write("case.toml", PLAIN + PUBLISHED.format(value=plain_force(1.4) / 2)))
        row, = self.rows(done.stdout)
        self.assertEqual(row[2:], [f"{plain_force(1.4) / 2:.6g}", f"{plain_force(1.4):.6g}", "100 %", "1 %", "reported"])

    def test_overrides_report_only(self):
        case = self.write("missed.toml", MISSED)
        done = self.command("verify", case, "--set", "geometry.box.points=[10,10]")
        row, = self.rows(done.stdout)
        self.assertEqual(row[-3:], ["2 %", "0.1 %", "reported"])
        self.assertIn("decide nothing", done.stdout.splitlines()[-1])
        done = self.command("verify", case, "--set", "solver.stretch=[1.1]")
        self.assertIn("not compared: 1 at states that this run does not reach", done.stdout)

    def test_the_short_variant_has_its_own_expectations(self):
        case = self.write("case.toml", SHORT)
        self.command("verify", case, expect=1)
        done = self.command("verify", case, "--short")
        self.assertEqual(done.stdout.splitlines()[0], "case (short): Sheet")
        row, = self.rows(done.stdout)
        self.assertEqual(row[1], "1.1")
        self.assertEqual(self.summary("results/case")["timing"]["points"], 100)
        self.command("verify", self.write("case.toml", replaced(SHORT, f"{plain_force(1.1):.9g}", "1")), "--short",
                     expect=1)

    def test_expectations_that_cannot_be_compared(self):
        for old, new, message in [('"force_x"', '"force_z"', "the case has no metric"), (" N\"", " Pa\"", "is in N"),
                                  ("at = 1.4", "at = 1.3", "no output state at 1.3")]:
            case = self.write("case.toml", replaced(MISSED, old, new))
            done = self.command("verify", case, expect=2)
            self.assertRegex(done.stderr, r"error: .*case\.toml:\d+:\d+: ")
            self.assertIn(message, done.stderr)
            self.assertFalse((self.top / "results").exists(), "it was found before the run")
        text = PLAIN + '\n[[expect]]\nfield = "displacement"\nfile = "no.csv"\ntolerance = 0.1\nkind = "reference"\n'
        self.assertIn("no.csv: there is no such file", self.command("verify", self.write("case.toml", text), expect=2).stderr)

    def test_a_folder_is_gone_through_to_the_end(self):
        self.write("home/cases/topic/a-wrong.toml", replaced(MET, "title", "titel"))
        self.write("home/cases/topic/b-failing.toml", replaced(MET, "[1.2, 1.4]", "[1.2, 1.4]\nmax_iterations = 1")
                   + '\n[[hole]]\ndisc = { radius = "30 mm" }\n')
        self.write("home/cases/topic/c-missed.toml", MISSED)
        self.write("home/cases/topic/d-met.toml", MET)
        environment = {"RIVEN_HOME": str(self.top / "home")}
        done = self.command("verify", "topic", expect=3, environment=environment)
        self.assertEqual(done.stdout.splitlines()[-1], "1 of 4 cases meet their references, 1 missed, 2 failed")
        self.assertIn('did you mean "title"?', done.stderr)
        self.assertIn("topic/b-failing: the run failed; see results/topic/b-failing/riven.log", done.stdout)
        self.assertEqual(self.command("verify", expect=3, environment=environment).stdout.splitlines()[-1],
                         done.stdout.splitlines()[-1])

    def test_results_of_its_own_are_replaced_and_no_others(self):
        case = self.write("met.toml", MET)
        self.command("verify", case)
        self.command("verify", case)
        self.assertIn("force_x", (self.top / "results/met/verification.txt").read_text())
        self.command("run", case, "--force")
        before = (self.top / "results/met/riven.log").read_text()
        self.assertIn("results/met: exists already", self.command("verify", case, expect=2).stderr)
        self.assertEqual((self.top / "results/met/riven.log").read_text(), before)
        self.command("verify", case, "--force")
        note = self.write("results/other/note.txt", "dear")
        for force in [], ["--force"]:
            said = self.command("verify", self.write("other.toml", MET), *force, expect=2).stderr
            self.assertIn("not a result of Riven" if force else "exists already", said)
        self.assertEqual(note.read_text(), "dear")

    def test_the_gallery_shows_every_case(self):
        self.write("home/cases/topic/failing.toml", replaced(replaced(MET, "[1.2, 1.4]", "[1.2, 1.4]\nmax_iterations = 1"),
                                                             'title = "Sheet"', 'title = "A <hole> & more"')
                   + '\n[[hole]]\ndisc = { radius = "30 mm" }\n')
        self.write("home/cases/topic/met.toml", MET)
        self.write("home/cases/other/missed.toml", MISSED)
        self.write("home/cases/other/wrong.toml", replaced(MET, "title", "titel"))
        done = self.command("verify", "--report", expect=3, environment={"RIVEN_HOME": str(self.top / "home")})
        self.assertEqual(done.stderr.splitlines()[-1], "gallery: results/gallery.html")
        page = (self.top / "results/gallery.html").read_text(encoding="utf-8")
        self.assertIn(done.stdout.splitlines()[-1], page)
        articles = {a.get("id"): a for a in Page.read(page).iter("article")}
        self.assertEqual(list(articles), ["other/missed", "other/wrong", "topic/failing", "topic/met"])
        status = {name: a.find("header/span[last()]").text for name, a in articles.items()}
        self.assertEqual(status, {"other/missed": "missed", "other/wrong": "failed", "topic/failing": "failed",
                                  "topic/met": "ok"})
        self.assertEqual(articles["topic/failing"].find("header/h3").text, "A <hole> & more")
        self.assertIn('did you mean "title"?', "".join(articles["other/wrong"].itertext()))
        self.assertIn("the run failed; see results/topic/failing/riven.log", "".join(articles["topic/failing"].itertext()))
        # The table is the one on the screen, without the columns that this case leaves empty.
        cells = [[td.text or "" for td in tr] for tr in articles["topic/met"].iter("tr")]
        printed = self.rows(done.stdout[done.stdout.index("topic/met"):])
        self.assertEqual(cells[0], ["metric", "at", "reference", "ours", "deviation", "limit", ""])
        self.assertEqual(cells[1:], printed)
        for name in ("topic/met", "other/missed"):
            picture = articles[name].find(".//img").get("src")
            png = base64.b64decode(picture.removeprefix("data:image/png;base64,"), validate=True)
            self.assertTrue(png.startswith(b"\x89PNG"))
            self.assertLess(len(png), 150_000)
        links = [a.get("href") for a in Page.read(page).iter("a")]
        for link in links:
            if link.startswith("#"):
                self.assertIn(f'id="{link[1:]}"', page)
            else:
                self.assertTrue((self.top / "results" / link).exists(), link)
        self.assertNotRegex(page, "https?://|<script")

    def test_a_shipped_case(self):
        done = self.command("verify", "neo-hookean-membrane/equibiaxial-plain", "--set", "geometry.box.points=[16,16]")
        self.assertIn("Bang", (self.top / "results/neo-hookean-membrane/equibiaxial-plain/case.toml").read_text())
        deviations = [row[-3 if len(row) > 6 else -2] for row in self.rows(done.stdout) if "reported" in row]
        self.assertGreaterEqual(len(deviations), 8)


if __name__ == "__main__":
    unittest.main()
