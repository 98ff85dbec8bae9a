// SPDX-License-Identifier: Apache-2.0
// `bodyloom animate person --score`: the rest of that verb needs no LibTorch (apps/animate_person.cc).
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/neural/neural_verbs.h"
#include "apps/neural/score_options.h"
#include "apps/progress.h"
#include "apps/usage_error.h"

namespace bodyloom {

void AddScorePerson(CLI::App& animate, Action* action) {
  CLI::App* verb = animate.add_subcommand("person", "Measures people who are made from photos; nothing is trained");
  auto request = std::make_shared<ScorePeopleRequest>();
  request->renderer = PeopleRenderer::kPerson;
  AddScoreOptions(verb, request.get());
  verb->get_option("--score")->required();
  verb->add_flag_function(
      "--score-floor", [request](int64_t) { request->renderer = PeopleRenderer::kWarp; },
      "Measure the floor instead: the bare body as far as the photos show it, black elsewhere");
  verb->add_option("--size", request->size, "Pixels of the windows' sides")
      ->check(CLI::Range(32, 2048))
      ->capture_default_str();
  verb->add_option("--texture-size", request->texture_size, "Texels a side")
      ->check(CLI::Range(64, 8192))
      ->capture_default_str();
  verb->add_option("--body", request->body, BodyHelp("The people's body"));
  verb->add_option("--sheet", request->sheet, "Contact sheet, a row a person: photo, what it shows, result, truth");
  verb->add_option("--json", request->json, "Report");
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::Range(0, 1024));
  verb->footer("Example:\n  bodyloom animate person --score people --score-photos 1 2 4 --size 512 --sheet people.png");
  verb->callback([request, action] { *action = [request] { Print(RunWithBar("scores", ScorePeople, *request)); }; });
}

}  // namespace bodyloom
