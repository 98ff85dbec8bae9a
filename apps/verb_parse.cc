// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "apps/detector_options.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/photo_avatar/make_photo_person.h"

namespace bodyloom {
namespace {

void RunParse(const PhotoParseRequest& request) {
  if (request.out.empty() && request.picture.empty()) throw RequestError("--out or --picture: where the labels go");
  const PhotoParseSummary summary = RunWithBar("parse", ParsePhoto, request);
  int person = 0;
  for (size_t k = 1; k < summary.pixels.size(); ++k) person += summary.pixels[k];
  std::printf("%d pixels of the person:", person);
  for (size_t k = 1; k < summary.pixels.size(); ++k) {
    std::printf("%s %s %.0f %%", k == 1 ? "" : ",", kPersonLabelNames[k],
                100.0 * summary.pixels[k] / std::max(1, person));
  }
  std::printf("\n");
  std::fflush(stdout);
  for (const std::string& path : summary.written) std::cout << "wrote " << path << "\n";
}

}  // namespace

void AddParseVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("parse", "Tells clothes, hair and skin of the person in a photo apart");
  auto request = std::make_shared<PhotoParseRequest>();
  verb->add_option("image", request->image, "The photo")->required()->type_name("FILE");
  verb->add_option("--out", request->out,
                   "The labels, .png: 0 background, 1 top, 2 bottom, 3 face, 4 hair, 5 skin, 6 shoes")
      ->type_name("FILE");
  verb->add_option("--picture", request->picture, "The photo tinted by label, .png or .jpg")->type_name("FILE");
  verb->add_option("--weights", request->weights,
                   "What tells them apart: builtin (the network that ships), body (what the fitted body shows "
                   "nearest), or weights of your own (bodyloom train parser)")
      ->capture_default_str();
  verb->add_option("--person", request->fit.person, "Of several people in the photo: 0 is the largest")
      ->capture_default_str();
  verb->add_option("--body", request->fit.body, BodyHelp("The body that is fitted"));
  verb->add_option("--focal", request->fit.focal_px, "The photo's focal length in pixels (default: estimated)");
  verb->add_option("--stature", request->fit.stature_m, "The person's height in metres (default: average)");
  AddDetectorOptions(*verb, &request->fit.detector, &request->fit.detect_rate, "Detection");
  verb->footer(std::string("The pose detector's networks: ./dev models.\n"
                           "Example:\n  bodyloom parse me.jpg --picture parsed.jpg --out labels.png\n\n") +
               kExitCodeHelp);
  verb->callback([request, action] { *action = [request] { RunParse(*request); }; });
}

}  // namespace bodyloom
