#include "input/study_format.hpp"

namespace riven {

Format describe(std::optional<StudyInput>& study) {
  if (!study) study.emplace();
  return {
      .doc = "What `riven sweep CASE` runs and draws if it is given no keys of its own.",
      .at = &study->at,
      .keys =
          {Key{"keys", kind::Texts{&study->keys},
               "As on the command line of `riven sweep`: `\"path.to.key = a, b, c\"`, or keys that change "
               "together, `\"first.key, second.key = (a, b), (c, d)\"`; all combinations are run."}
               .required(),
           Key{"plots", kind::Texts{&study->plots},
               "As for `--plot`: `\"x, y\"`, a curve of each variant, or `\"key, metric\"`, the metrics at "
               "the end over a key."}},
      .finish = [&study](const Check& check) {
        if (study->keys.empty()) check.fail("keys", "found an empty list; expected a key and its values");
      }};
}

}  // namespace riven
