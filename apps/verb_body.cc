// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/exit_code.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/body_making/make_builtin_body.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

struct BodyCommand {
  std::string body, out, uv, parts;  // info, convert
  LoadBodyOptions load;
  std::string cage, cage_parts;  // make
};

void Info(const BodyCommand& command) {
  RequireReadable(command.body, "body model");
  std::cout << DescribeBody(*BodyOrBuiltin(command.body));
}

void Convert(const BodyCommand& command) {
  RequireReadable(command.body, "body model");
  RequireReadable(command.uv, "texture coordinates");
  RequireReadable(command.parts, "body parts");
  RequireDistinct({command.body, command.uv, command.parts}, {command.out});
  RequireWritable(command.out);
  BodyModelData body = LoadBodyData(command.body, command.load);
  if (!command.uv.empty()) {
    UvFromObj(command.uv, &body);
  }
  if (!command.parts.empty()) {
    const PartsSummary parts = PartsFromUvProcessedMat(command.parts, &body);
    std::cout << parts.faces_with_part << " faces have a part, " << parts.faces_without_part << " have none\n";
  }
  SaveBodyCompact(command.out, body);
  std::cout << DescribeBody(BodyModel(std::move(body))) << "wrote " << command.out << "\n";
}

void Make(const BodyCommand& command) {
  RequireReadable(command.cage, "cage");
  RequireReadable(command.cage_parts, "parts on the cage");
  RequireDistinct({command.cage, command.cage_parts}, {command.out});
  RequireWritable(command.out);
  const BuiltinBodySources sources =
      command.cage.empty() ? EmbeddedBuiltinBodySources() : ReadBuiltinBodySources(command.cage, command.cage_parts);
  MakeBuiltinBodySummary summary;
  BodyModelData body = MakeBuiltinBody(sources, &summary);
  SaveBodyCompact(command.out, body);
  std::cout << "cage of " << summary.cage_vertices << " vertices and " << summary.cage_quads << " quads -> "
            << summary.vertices << " vertices, " << summary.quads << " quads\n"
            << DescribeBody(BodyModel(std::move(body))) << "wrote " << command.out << "\n";
}

}  // namespace

void AddBodyVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("body", "Describes, converts and makes body models");
  verb->require_subcommand(1);
  verb->footer(kExitCodeHelp);
  auto command = std::make_shared<BodyCommand>();
  BodyCommand& c = *command;

  CLI::App* info = verb->add_subcommand("info", "Prints what a body file holds and what it lacks");
  info->add_option("--body,body", c.body, "body model (default: the built-in body)")->type_name("FILE");
  info->footer("Example:\n  bodyloom body info SMPL_NEUTRAL.pkl\n");
  info->callback([command, action] { *action = [command] { Info(*command); }; });

  CLI::App* convert = verb->add_subcommand("convert", "Turns any readable body into one compact file");
  convert->add_option("--body", c.body, "SMPL, SMPL-H or SMPL-X .pkl or .npz")->required()->type_name("FILE");
  convert->add_option("--out", c.out, "the compact body, .npz")->required()->type_name("FILE");
  convert->add_option("--uv", c.uv, "take texture coordinates from an OBJ with the body's vertices")->type_name("OBJ");
  convert->add_option("--parts", c.parts, "take body parts from DensePose's UV_Processed.mat")->type_name("MAT");
  convert->add_option("--betas", c.load.max_betas, "keep the first N shape components (0: all)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  convert->add_flag("--flat-hands", c.load.flat_hand_mean, "SMPL-H/X: zero hand angles are a flat hand, as in AMASS");
  convert->footer("Example:\n  bodyloom body convert --body SMPL_NEUTRAL.pkl --uv smpl_uv.obj --out smpl.npz\n");
  convert->callback([command, action] { *action = [command] { Convert(*command); }; });

  CLI::App* make = verb->add_subcommand("make", "Builds the built-in body from its cage");
  make->add_option("--out", c.out, "the compact body, .npz")->required()->type_name("FILE");
  CLI::Option* cage = make->add_option("--cage", c.cage, "another cage (default: the one in this program)");
  cage->type_name("FILE");
  CLI::Option* parts = make->add_option("--parts", c.cage_parts, "weights, shapes and charts on that cage");
  parts->type_name("FILE")->needs(cage);
  cage->needs(parts);
  make->footer("Example:\n  bodyloom body make --out mannequin.npz\n");
  make->callback([command, action] { *action = [command] { Make(*command); }; });
}

}  // namespace bodyloom
