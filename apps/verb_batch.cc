// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>
#include <memory>

#include "apps/batch_progress.h"
#include "apps/clip_settings.h"
#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/batch/merge_results.h"
#include "bodyloom/pipelines/batch/run_batch.h"
#include "bodyloom/pipelines/batch/shard.h"
#include "bodyloom/pipelines/batch/work_place.h"

namespace bodyloom {
namespace {

constexpr const char* kBatchFooter =
    "A line of the manifest is a JSON object: the clip's id, its input, and options of `track` or `run` by their "
    "names:\n"
    "  {\"id\": \"dance_01\", \"detections\": \"dance_01.json\", \"image-size\": \"1920x1080\", \"fps\": 60}\n"
    "  {\"id\": \"street\", \"video\": \"street.mp4\", \"people\": 2}\n"
    "Results go to DIR/clips/ID; what is there from the same inputs and options is left. A JSON line a clip to "
    "stdout.\n"
    "Examples:\n"
    "  bodyloom batch --manifest clips.jsonl --out results --shard 0/6   the first of six (Slurm: the array's task)\n"
    "  bodyloom batch --merge --out results                              one table and one page, the worst first\n\n"
    "Exit codes: 0 all is done, 1 a clip or the manifest cannot be used, 2 wrong usage, 3 some clips show nobody and "
    "the\n"
    "rest is done, 75 not finished (interrupted, disk full, another process at a clip): run it again.";

struct BatchCommand {
  std::string manifest, out, shard, progress = "text";
  int jobs = 0;
  bool merge = false;
};

RunBatchRequest RequestFrom(const BatchCommand& command, const ClipSettings& common) {
  if (command.manifest.empty()) throw RequestError("--manifest is required (or --merge)");
  const int cores = ThreadsFor(0), jobs = command.jobs > 0 ? command.jobs : cores;
  RunBatchRequest request;
  request.out = command.out;
  request.jobs = jobs;
  request.manifest = ReadFileBytes(command.manifest);
  const std::vector<ManifestClip> listed = ManifestFromText(request.manifest, command.manifest);
  const Shard shard = ChooseShard(command.shard, static_cast<char* (*)(const char*)>(std::getenv));
  for (size_t i = 0; i < listed.size(); ++i) {
    if (shard.Holds(i)) request.clips.push_back(ClipFrom(listed[i], common, std::max(1, cores / jobs)));
  }
  return request;
}

void RunAndTell(const RunBatchRequest& request, const std::string& style) {
  BatchProgressPrinter printer(style, std::cerr);
  BatchCallbacks callbacks;
  callbacks.progress = [&](const BatchProgress& at) {
    printer.Update(at);
    return !IsInterrupted();
  };
  callbacks.ended = [&](const ClipRecord& record) {
    printer.Wipe();
    std::cout << ToLine(record) << std::endl;
  };
  callbacks.message = [&](const std::string& line) {
    printer.Wipe();
    std::cerr << line << std::endl;
  };
  const RunBatchReport report = RunBatch(request, callbacks);
  printer.Wipe();
  const std::string text = ToText(report);
  if (report.Count(ClipStatus::kRetry) > 0) throw CommandEnded(kExitRetry, text);
  if (report.Count(ClipStatus::kFailed) > 0) throw CommandEnded(kExitFailed, text);
  if (report.Count(ClipStatus::kNothingToTrack) > 0) throw CommandEnded(kExitNothingToTrack, text);
  if (style == "text") std::cerr << text << "\n";
}

/// What another try may do gets its own exit code.
void RunBatchCommand(const BatchCommand& command, const ClipSettings& common) {
  try {
    if (command.merge) {
      std::cout << ToText(MergeResults({command.out, command.manifest}));
    } else {
      RunAndTell(RequestFrom(command, common), command.progress);
    }
  } catch (const DiskFullError& error) {
    throw CommandEnded(kExitRetry, error.what());
  } catch (const PlaceTaken& error) {
    throw CommandEnded(kExitRetry, command.out + ": " + error.what());
  }
}

}  // namespace

void AddBatchVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("batch", "Many clips, each once: resumable, in shards, on clusters");
  verb->footer(kBatchFooter);
  auto command = std::make_shared<BatchCommand>();
  verb->add_option("--manifest", command->manifest, "the clips, one JSON object a line")->type_name("FILE");
  verb->add_option("--out", command->out, "folder for the results, made when it is not there")
      ->required()
      ->type_name("DIR");
  verb->add_option("--shard", command->shard, "only every N-th clip, from the i-th on, i counted from 0")
      ->type_name("i/N");
  verb->add_option("--jobs", command->jobs, "clips at once, which share the cores (default: one a core)")
      ->check(CLI::Range(1, 256));
  verb->add_option("--progress", command->progress, "on stderr: text, json (lines for a program) or none")
      ->check(CLI::IsMember({"text", "json", "none"}))
      ->capture_default_str();
  verb->add_flag("--merge", command->merge,
                 "write clips.csv, clips.jsonl and index.html from the results that are there");
  const std::function<ClipSettings()> common = AddClipOptions(*verb);
  verb->callback([=] { *action = [=] { RunBatchCommand(*command, common()); }; });
}

}  // namespace bodyloom
