// SPDX-License-Identifier: Apache-2.0
#include "pipelines/synthesis/synthesize_person.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "data_tools/body/builtin_body.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/video/image_file.h"
#include "geometry/cloth/cloth_run.h"
#include "pipelines/files.h"
#include "pipelines/report_json.h"
#include "pipelines/report_text.h"

namespace bodyloom {
namespace {

/// The command that makes the same, for person.json.
std::string CommandLine(const SynthesizePersonRequest& c) {
  std::string line = "bodyloom synth-person";
  for (const std::string& motion : c.motions) line += " --motion " + motion;
  line += " --out " + c.out + " --garment " + ToString(c.set.garment);
  if (c.set.style != ClothesStyle::kPatterned) line += " --clothes " + ToString(c.set.style);
  if (c.set.material != ClothMaterial::kCotton) line += " --material " + ToString(c.set.material);
  if (c.set.light_style != LightStyle::kStudio) line += " --light-style " + ToString(c.set.light_style);
  line += " --seed " + std::to_string(c.set.seed);
  if (c.set.light_seed) line += " --light-seed " + std::to_string(*c.set.light_seed);
  line += " --size " + std::to_string(c.set.size_px);
  const auto add = [&](const char* option, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), " %s %g", option, value);
    line += text.data();
  };
  if (c.speeds != std::vector<double>{1}) {
    for (const double speed : c.speeds) add("--speed", speed);
  }
  add("--fps", c.motion.fps), add("--yaw", c.set.yaw_deg), add("--elevation", c.set.elevation_deg);
  line += " --first " + std::to_string(c.motion.first_frame) + " --frames " + std::to_string(c.motion.num_frames);
  return c.body.empty() ? line : line + " --body " + c.body;
}

/// "linear": pixel values are the surface's colours times the light.
nlohmann::ordered_json LightJson(const PersonLight& light) {
  nlohmann::ordered_json lights = nlohmann::ordered_json::array();
  for (size_t k = 0; k < light.towards.size(); ++k) {
    const Eigen::Vector3f& towards = light.towards[k];
    // In the viewer's axes.
    lights.push_back({{"from", {towards.x(), -towards.y(), -towards.z()}}, {"intensity", light.strength[k]}});
  }
  return {{"directional", lights}, {"ambient", light.ambient}, {"encoding", "linear"}};
}

/// All of them in one world with y up.
Motion LoadMotions(const SynthesizePersonRequest& request, const BodyModel& body, const PipelineCallbacks& callbacks) {
  const Eigen::Vector3d pelvis = body.RestJoints(Eigen::VectorXd::Zero(body.num_betas())).row(0).transpose();
  std::vector<Motion> motions;
  for (const std::string& name : request.motions) {
    MotionSource source = request.motion;
    source.name = name;
    for (const double speed : request.speeds) {
      source.speed = speed;
      motions.push_back(LoadMotionSource(source, body, callbacks));
      if (request.motions.size() > 1) motions.back() = ChangeUp(motions.back(), Motion::Up::kY, pelvis);
    }
  }
  // So far apart that the cloth of one motion is not led into the next.
  return motions.size() == 1 ? motions.front() : JoinMotions(motions, ClothRunOptions().cut_pause_s);
}

}  // namespace

SynthesizePersonReport SynthesizePerson(const SynthesizePersonRequest& request, const PipelineCallbacks& callbacks) {
  for (const std::string& motion : request.motions) {
    if (motion != "demo") RequireReadable(motion, "motion");
  }
  if (!(request.motion.fps > 0) && request.speeds != std::vector<double>{1}) {
    throw RequestError("--speed needs --fps: the rate of the images");
  }
  RequireReadableBody(request.body);
  RequireWritableFolder(request.out);
  RequireWritable(request.sheet);
  RequireWritable(request.light);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  const Motion motion = LoadMotions(request, *body, callbacks);
  callbacks.Update("person", 0);
  MakeSinglePersonDatasetOptions set = request.set;
  set.motion.clear();
  for (const std::string& name : request.motions) {
    set.motion += (set.motion.empty() ? "" : " ") + std::filesystem::path(name).filename().string();
  }
  set.command = CommandLine(request);
  callbacks.Begin("dressing " + std::to_string(motion.num_frames()) + " frames");
  bool cancelled = false;
  set.progress = [&](double done) {
    cancelled = !callbacks.ReportProgress("person", done);
    return !cancelled;
  };
  PersonSheet sheet(motion.num_frames());
  if (!request.sheet.empty()) set.look = [&](int t, const PersonFrame& frame) { sheet.Take(t, frame); };
  SynthesizePersonReport report;
  report.set = MakeSinglePersonDataset(request.out, *body, motion, set);
  if (cancelled || !callbacks.ReportProgress("person", 1)) throw Cancelled();
  report.size_px = set.size_px;
  report.outputs = {request.out};
  if (!request.sheet.empty()) {
    WriteImage(request.sheet, sheet.Draw());
    report.outputs.push_back(request.sheet);
  }
  if (!request.light.empty()) {
    WriteReport(request.light, LightJson(report.set.light));
    report.outputs.push_back(request.light);
  }
  return report;
}

std::string ToText(const SynthesizePersonReport& report) {
  const MakeSinglePersonDatasetSummary& set = report.set;
  std::ostringstream text;
  text << set.frames << " frames of " << report.size_px << "x" << report.size_px << " in " << ClockText(set.seconds)
       << ", " << static_cast<int>(set.frames_per_second() * 10) / 10.0 << " a second\n";
  if (set.cloth_vertices > 0) {
    text << "cloth            " << set.cloth_vertices << " vertices, "
         << static_cast<int>(1e4 * set.cloth_seconds / set.frames) / 10.0 << " ms a frame, stretched by at most "
         << static_cast<int>(1000 * set.largest_stretch) / 10.0 << " %, " << set.cuts << " cuts, a leg through it in "
         << set.frames_through << " frames\n";
  }
  for (const std::string& path : report.outputs) text << "wrote            " << path << "\n";
  return text.str();
}

}  // namespace bodyloom
