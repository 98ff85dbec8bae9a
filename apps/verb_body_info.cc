// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/exec_beside.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "pipelines/body/check_body.h"
#include "pipelines/files.h"

namespace bodyloom {
namespace {

constexpr const char* kInfoFooter =
    "--check looks for what keeps the mesh from being the closed, outward surface of a solid: holes, edges of more "
    "than\n"
    "two faces, faces that face the wrong way, doubled or empty faces, doubled or unused vertices, loose components;\n"
    "and, where bodyloom-cgal lies beside bodyloom, faces that cross each other. It prints a line a finding, or\n"
    "\"nothing found\",\n"
    "and exits with 1 when something was found (with --repair: when something is left).\n"
    "Examples:\n"
    "  bodyloom body info SMPL_NEUTRAL.pkl\n"
    "  bodyloom body info mine.npz --check --repair mended.npz\n"
    "  bodyloom body info mine.npz --check --track track.npz --frames 0:100      also in these poses\n\n";

struct InfoArguments {
  CheckBodyRequest request;
  bool check = false, quiet = false;
};

void Info(const InfoArguments& arguments, const std::vector<std::string>& command) {
  const CheckBodyRequest& request = arguments.request;
  RequireReadableBody(request.body);
  if (arguments.check && !request.surface_tools.crossing) ExecBeside("bodyloom-cgal", command);
  std::cout << DescribeBody(*BodyOrBuiltin(request.body));
  if (!arguments.check) return;
  const CheckBodyReport report = CheckBody(request, CommandCallbacks(arguments.quiet));
  std::cout << ToText(report) << std::flush;
  if (report.remaining().empty()) return;
  throw std::runtime_error((request.body.empty() ? "the built-in body" : request.body) + ": the mesh has faults of " +
                           std::to_string(report.remaining().size()) + " kinds, expected none");
}

}  // namespace

void AddBodyInfo(CLI::App& verb, Action* action, const std::vector<std::string>& command, SurfaceTools tools) {
  auto arguments = std::make_shared<InfoArguments>();
  CheckBodyRequest& to_check = arguments->request;
  to_check.surface_tools = std::move(tools);
  CLI::App* info = verb.add_subcommand("info", "Prints what a body file holds and what it lacks");
  info->add_option("--body,body", to_check.body, BodyHelp("body model"))->type_name("FILE");
  CLI::Option* check = info->add_flag("--check", arguments->check, "look for faults of its mesh (below)");
  CLI::Option* track = info->add_option("--track", to_check.track, "also for crossing faces in its poses, .npz");
  track->type_name("FILE")->needs(check);
  info->add_option("--frames", to_check.frames, "only frames a to b-1; one number: that frame (default: all)")
      ->type_name("a:b")
      ->needs(track);
  CLI::Option* repair =
      info->add_option("--repair", to_check.repair, "write the body with what can be mended mended, .npz");
  repair->type_name("FILE")->needs(check);
  info->add_option("--max-hole", to_check.max_hole_edges, "--repair fills holes of at most so many edges (0: none)")
      ->check(CLI::Range(0, 1000))
      ->type_name("EDGES")
      ->needs(repair)
      ->capture_default_str();
  info->add_option("--same-place", to_check.same_place_mm, "vertices no further apart are one place")
      ->check(CLI::Range(0.0, 100.0))
      ->type_name("MM")
      ->needs(check)
      ->capture_default_str();
  info->add_flag("--quiet", arguments->quiet, "no progress");
  info->footer(kInfoFooter);
  info->callback([=] { *action = [=] { Info(*arguments, command); }; });
}

}  // namespace bodyloom
