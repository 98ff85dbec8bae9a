// SPDX-License-Identifier: Apache-2.0
#include "pipelines/synthesis/synthesize_people.h"

#include <array>
#include <cstdio>
#include <memory>
#include <sstream>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/multi_person_dataset.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/video/image_file.h"
#include "pipelines/files.h"
#include "pipelines/report_text.h"
#include "pipelines/synthesis/motion_source.h"

namespace bodyloom {
namespace {

constexpr double kFps = 30;

/// The command that makes the same, for people.json.
std::string CommandLine(const SynthesizePeopleRequest& c) {
  std::string line = "bodyloom synth-people";
  for (const std::string& motions : c.motions) line += " --motions " + motions;
  line += " --out " + c.out;
  const auto add = [&](const char* option, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), " %s %g", option, value);
    line += text.data();
  };
  add("--people", c.set.people), add("--actions", c.set.actions), add("--views", c.set.views);
  add("--frames", c.set.frames), add("--every", c.set.every), add("--test-share", c.set.test_share);
  add("--size", c.set.size_px), add("--shape", c.set.shape_sigma);
  if (c.set.style != ClothesStyle::kPatterned) line += " --clothes " + ToString(c.set.style);
  if (c.set.light_style != LightStyle::kStudio) line += " --light-style " + ToString(c.set.light_style);
  line += " --seed " + std::to_string(c.set.seed);
  return c.body.empty() ? line : line + " --body " + c.body;
}

/// Those that are long enough, at the common rate; `too_short` counts the others.
std::vector<Motion> LoadMotions(const SynthesizePeopleRequest& request, const BodyModel& body,
                                const PipelineCallbacks& callbacks, int* too_short) {
  std::vector<Motion> motions;
  const int length = (request.set.frames - 1) * request.set.every + 1;
  const auto take = [&](const Motion& motion) {
    Motion resampled = ResampleMotion(motion, kFps);
    if (resampled.num_frames() >= length) {
      motions.push_back(std::move(resampled));
    } else {
      ++*too_short;
    }
  };
  std::vector<std::string> folders;
  for (const std::string& name : request.motions) {
    if (name != "demo") {
      RequireReadable(name, "motions");
      folders.push_back(name);
      continue;
    }
    take(LoadMotionSource({.name = name}, body));
  }
  if (!folders.empty()) {
    const MotionLibrarySummary library =
        VisitMotionLibrary(folders, {}, [&](LibraryClip&& clip) { take(clip.motion); });
    for (const std::string& warning : library.warnings) callbacks.Message(warning);
  }
  if (motions.empty()) {
    throw RequestError("--motions: none is as long as a clip, " + std::to_string(length) +
                       " frames; give others, or fewer --frames or --every");
  }
  return motions;
}

}  // namespace

SynthesizePeopleReport SynthesizePeople(const SynthesizePeopleRequest& request, const PipelineCallbacks& callbacks) {
  RequireReadableBody(request.body);
  RequireWritableFolder(request.out);
  RequireWritable(request.sheet);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  SynthesizePeopleReport report;
  report.people = request.set.people;
  const std::vector<Motion> motions = LoadMotions(request, *body, callbacks, &report.motions_too_short);
  callbacks.Update("people", 0);
  MakeMultiPersonDatasetOptions set = request.set;
  set.command = CommandLine(request);
  callbacks.Begin("dressing " + std::to_string(set.people) + " people");
  bool cancelled = false;
  set.progress = [&](double done) {
    cancelled = cancelled || !callbacks.ReportProgress("people", done);
    return !cancelled;
  };
  report.set = MakeMultiPersonDataset(request.out, *body, motions, set);
  if (cancelled || !callbacks.ReportProgress("people", 1)) throw Cancelled();
  report.outputs = {request.out};
  if (!request.sheet.empty()) {
    WriteImage(request.sheet, PeopleSheet(request.out));
    report.outputs.push_back(request.sheet);
  }
  return report;
}

std::string ToText(const SynthesizePeopleReport& report) {
  std::ostringstream text;
  if (report.motions_too_short > 0) {
    text << report.motions_too_short << " motions were too short for a clip and left out\n";
  }
  const double minutes = report.set.seconds / 60;
  text << report.set.images << " images of " << report.people << " people in " << ClockText(report.set.seconds) << ", "
       << static_cast<int>(report.set.images / minutes) << " a minute; " << report.set.pairs
       << " pairs of two images of one person\n";
  for (const std::string& path : report.outputs) text << "wrote            " << path << "\n";
  return text.str();
}

}  // namespace bodyloom
