// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/body/convert_body.h"

namespace bodyloom {
namespace {

struct BodyArguments {
  ConvertBodyRequest convert;
  BuildBuiltinBodyRequest make;
};

void Convert(const ConvertBodyRequest& request) {
  const ConvertBodyReport report = ConvertBody(request, CommandCallbacks());
  std::cout << report.description << "wrote " << report.out << "\n";
}

void Make(const BuildBuiltinBodyRequest& request) {
  const BuildBuiltinBodyReport report = BuildBuiltinBody(request, CommandCallbacks());
  const MakeBuiltinBodySummary& summary = report.summary;
  std::cout << "cage of " << summary.cage_vertices << " vertices and " << summary.cage_quads << " quads -> "
            << summary.vertices << " vertices, " << summary.quads << " quads\n"
            << report.description << "wrote " << report.out << "\n";
}

}  // namespace

void AddBodyVerb(CLI::App& app, Action* action, const std::vector<std::string>& command, SurfaceTools tools) {
  CLI::App* verb = app.add_subcommand("body", "Describes, converts and makes body models");
  verb->require_subcommand(1);
  verb->footer(kExitCodeHelp);
  auto arguments = std::make_shared<BodyArguments>();
  ConvertBodyRequest& to_convert = arguments->convert;
  BuildBuiltinBodyRequest& to_make = arguments->make;

  AddBodyInfo(*verb, action, command, std::move(tools));
  CLI::App* convert = verb->add_subcommand("convert", "Turns any readable body into one compact file");
  convert->add_option("--body", to_convert.body, "SMPL, SMPL-H or SMPL-X .pkl or .npz")->required()->type_name("FILE");
  convert->add_option("--out", to_convert.out, "the compact body, .npz")->required()->type_name("FILE");
  convert->add_option("--uv", to_convert.uv, "take texture coordinates from an OBJ with the body's vertices")
      ->type_name("OBJ");
  convert->add_option("--parts", to_convert.parts, "take body parts from DensePose's UV_Processed.mat")
      ->type_name("MAT");
  convert->add_option("--betas", to_convert.load.max_betas, "keep the first N shape components (0: all)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  convert->add_flag("--flat-hands", to_convert.load.flat_hand_mean,
                    "SMPL-H/X: zero hand angles are a flat hand, as in AMASS");
  convert->footer("Example:\n  bodyloom body convert --body SMPL_NEUTRAL.pkl --uv smpl_uv.obj --out smpl.npz\n");
  convert->callback([arguments, action] { *action = [arguments] { Convert(arguments->convert); }; });

  CLI::App* make = verb->add_subcommand("make", "Builds the built-in body from its cage");
  make->add_option("--out", to_make.out, "the compact body, .npz")->required()->type_name("FILE");
  make->add_flag("--hands", to_make.hands, "with finger joints, 52 joints in all: the body of --body hands");
  CLI::Option* cage = make->add_option("--cage", to_make.cage, "another cage (default: the one in this program)");
  cage->type_name("FILE");
  CLI::Option* parts = make->add_option("--parts", to_make.parts, "weights, shapes and charts on that cage");
  parts->type_name("FILE")->needs(cage);
  cage->needs(parts);
  make->footer("Example:\n  bodyloom body make --out mannequin.npz\n");
  make->callback([arguments, action] { *action = [arguments] { Make(arguments->make); }; });
}

}  // namespace bodyloom
