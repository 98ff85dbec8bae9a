// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/motion_run.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace bodyloom {

using Json = nlohmann::ordered_json;

std::string MotionRunJson(const MotionRun& run) {
  const MotionConfig& c = run.config;
  Json json = {{"program", "bodyloom train motion"},
               {"version", BODYLOOM_VERSION},
               {"profile", c.profile.name},
               {"image_size", c.profile.image_size},
               {"uv_size", c.profile.uv_size},
               {"features", c.profile.features},
               {"encoder_widths", c.profile.encoder_widths},
               {"decoder_widths", c.profile.decoder_widths},
               {"discriminator_width", c.profile.discriminator_width},
               {"perceptual_divisor", c.profile.perceptual_divisor},
               {"motion_channels", c.motion_channels},
               {"num_labels", c.num_labels},
               {"shape", c.shape},
               {"normals", c.normals},
               {"motion", c.motion},
               {"surface", c.surface},
               {"pixels_per_metre", run.pixels_per_metre},
               {"fps", run.fps},
               {"past", run.past},
               {"reach", run.reach}};
  if (!run.notes.empty()) json["run"] = Json::parse(run.notes);
  return json.dump(2) + "\n";
}

MotionRun ReadMotionRun(const std::string& run_dir) {
  const std::string path = (std::filesystem::path(run_dir) / "config.json").string();
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": not there, expected the folder of a run of `bodyloom train motion`");
  std::stringstream text;
  text << file.rdbuf();
  MotionRun run;
  std::string key = "program";
  try {
    const Json json = Json::parse(text.str());
    const auto get = [&](const char* name, auto* value) {
      key = name;
      json.at(name).get_to(*value);
    };
    std::string program;
    get("program", &program);
    if (program != "bodyloom train motion") {
      throw std::runtime_error(path + ": a run of \"" + program + "\", expected \"bodyloom train motion\"");
    }
    MotionConfig& c = run.config;
    get("profile", &c.profile.name);
    get("image_size", &c.profile.image_size);
    get("uv_size", &c.profile.uv_size);
    get("features", &c.profile.features);
    get("encoder_widths", &c.profile.encoder_widths);
    get("decoder_widths", &c.profile.decoder_widths);
    get("discriminator_width", &c.profile.discriminator_width);
    get("perceptual_divisor", &c.profile.perceptual_divisor);
    get("motion_channels", &c.motion_channels);
    get("num_labels", &c.num_labels);
    get("shape", &c.shape);
    get("normals", &c.normals);
    get("motion", &c.motion);
    get("surface", &c.surface);
    get("pixels_per_metre", &run.pixels_per_metre);
    get("fps", &run.fps);
    get("past", &run.past);
    get("reach", &run.reach);
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error(path + ": no usable \"" + key + "\", expected the config.json of `bodyloom train motion`");
  }
  std::string why;
  if (!run.config.IsValid(&why)) throw std::runtime_error(path + ": " + why);
  if (run.reach < 0 || run.past < 0 || 3 + 3 * run.past != run.config.motion_channels || !(run.pixels_per_metre > 0) ||
      !(run.fps > 0)) {
    throw std::runtime_error(path + ": past, reach, pixels_per_metre or fps do not make sense");
  }
  return run;
}

}  // namespace bodyloom
