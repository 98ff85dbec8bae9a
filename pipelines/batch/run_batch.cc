// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/run_batch.h"

#include <algorithm>
#include <atomic>
#include <deque>
#include <filesystem>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/observations/nothing_to_track.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/pipelines/batch/work_place.h"
#include "bodyloom/pipelines/fixed_text.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr int kMostJobs = 256;

std::string InOneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127; }, ' ');
  return text;
}

/// A name that no clip can have, so that the manifest's place is no clip's.
constexpr const char* kManifestPlace = ".manifest";

/// Leaves the manifest beside the results, unless another process is just doing so.
void KeepManifest(const RunBatchRequest& request) {
  if (request.manifest.empty()) return;
  const std::string target = BatchManifestFile(request.out);
  std::error_code ignored;
  if (fs::is_regular_file(target, ignored) && ReadFileBytes(target) == request.manifest) return;
  try {
    WorkPlace place(BatchWorkFolder(request.out), kManifestPlace);
    WriteFileAtomically(place.folder() + "/manifest.jsonl", request.manifest);
    place.MoveFileTo("manifest.jsonl", target);
  } catch (const PlaceTaken&) {
  }
}

class Batch {
 public:
  Batch(const RunBatchRequest& request, const BatchCallbacks& callbacks) : request_(request), callbacks_(callbacks) {
    parts_.resize(request.clips.size());
    for (size_t i = 0; i < request.clips.size(); ++i) waiting_.push_back({i, false});
  }

  void Work() {
    while (const std::optional<Turn> turn = Next()) {
      const BatchClip& clip = request_.clips[turn->clip];
      Stopwatch watch;
      ClipRecord record;
      try {
        record = RunClip(clip, turn->clip);
      } catch (const PlaceTaken& taken) {
        if (!turn->is_second && PutBack(turn->clip)) continue;
        record = Ended(ClipStatus::kRetry, taken.what());
      }
      record.id = clip.id;
      record.verb = VerbOf(clip);
      record.seconds = watch.seconds();
      Tell(turn->clip, record);
    }
  }

  [[nodiscard]] const std::map<ClipStatus, int>& counts() const { return counts_; }

 private:
  struct Turn {
    size_t clip = 0;
    bool is_second = false;  ///< another process was at it before
  };

  /// The next clip; none when all are taken, or it is time to stop: then the rest is told of.
  std::optional<Turn> Next() {
    const std::unique_lock<std::mutex> hold(mutex_);
    while (!waiting_.empty()) {
      const Turn turn = waiting_.front();
      waiting_.pop_front();
      if (why_stopped_.empty()) AskWhetherToGoOn(turn.clip, kBatchStageBegin, 0);
      if (why_stopped_.empty()) return turn;
      ClipRecord record = Ended(ClipStatus::kRetry, "not begun: " + why_stopped_);
      record.id = request_.clips[turn.clip].id;
      record.verb = VerbOf(request_.clips[turn.clip]);
      TellLocked(turn.clip, record);
    }
    return std::nullopt;
  }

  bool PutBack(size_t clip) {
    const std::unique_lock<std::mutex> hold(mutex_);
    if (!why_stopped_.empty()) return false;
    waiting_.push_back({clip, true});
    return true;
  }

  void Stop(const std::string& why) {
    const std::unique_lock<std::mutex> hold(mutex_);
    if (why_stopped_.empty()) why_stopped_ = why;
  }

  void AskWhetherToGoOn(size_t clip, const std::string& stage, double fraction) {
    parts_[clip] = fraction;
    if (!callbacks_.progress || !why_stopped_.empty()) return;
    double whole = 0;
    for (const double part : parts_) whole += part;
    const double all = static_cast<double>(parts_.size());
    const BatchProgress at = {request_.clips[clip].id,         stage,      fraction, ended_,
                              static_cast<int>(parts_.size()), whole / all};
    if (!callbacks_.progress(at)) why_stopped_ = "interrupted";
  }

  void Tell(size_t clip, const ClipRecord& record) {
    const std::unique_lock<std::mutex> hold(mutex_);
    TellLocked(clip, record);
  }
  void TellLocked(size_t clip, const ClipRecord& record) {
    parts_[clip] = 1;
    ++ended_;
    ++counts_[record.status];
    if (callbacks_.ended) callbacks_.ended(record);
  }

  static ClipRecord Ended(ClipStatus status, const std::string& reason) {
    ClipRecord record;
    record.status = status;
    record.reason = InOneLine(reason);
    return record;
  }

  PipelineCallbacks CallbacksOf(size_t clip) {
    PipelineCallbacks callbacks;
    callbacks.progress = [this, clip](const std::string& stage, double fraction) {
      const std::unique_lock<std::mutex> hold(mutex_);
      AskWhetherToGoOn(clip, stage, std::clamp(fraction, 0.0, 1.0));
      return why_stopped_.empty();
    };
    callbacks.message = [this, clip](const std::string& line) {
      const std::unique_lock<std::mutex> hold(mutex_);
      if (callbacks_.message) callbacks_.message(request_.clips[clip].id + ": " + line);
    };
    return callbacks;
  }

  /// The clip's record when it was done before.
  [[nodiscard]] std::optional<ClipRecord> Stored(const BatchClip& clip, const std::string& hash) const {
    std::optional<ClipRecord> record = ReadWholeClip(ClipFolder(request_.out, clip.id), clip.id);
    if (!record || record->hash != hash) return std::nullopt;
    ForgetFailure(clip);
    if (record->status == ClipStatus::kDone) record->status = ClipStatus::kSkipped;
    return record;
  }

  /// Throws PlaceTaken alone.
  ClipRecord RunClip(const BatchClip& clip, size_t index) {
    std::string hash;
    try {
      hash = ClipHash(clip, BODYLOOM_VERSION);
      if (std::optional<ClipRecord> stored = Stored(clip, hash)) return *stored;
      WorkPlace place(BatchWorkFolder(request_.out), clip.id);
      // Whoever had the place until now may have done it.
      if (std::optional<ClipRecord> stored = Stored(clip, hash)) return *stored;
      ClipRecord record = TrackInto(place.folder(), clip, index);
      record.hash = hash;
      Keep(clip, &record, &place);
      return record;
    } catch (const PlaceTaken&) {
      throw;
    } catch (const Cancelled&) {
      return Ended(ClipStatus::kRetry, WhyStopped());
    } catch (const DiskFullError& error) {
      Stop("out of room");
      return Ended(ClipStatus::kRetry, error.what());
    } catch (const std::bad_alloc&) {
      return Failure(clip, hash, "out of memory");
    } catch (const std::exception& error) {
      return Failure(clip, hash, error.what());
    }
  }

  ClipRecord TrackInto(const std::string& folder, const BatchClip& clip, size_t index) {
    Stopwatch watch;
    ClipRecord record;
    try {
      record = TrackBatchClip(clip, folder, CallbacksOf(index));
    } catch (const NothingToTrack& nothing) {
      for (const fs::directory_entry& left : fs::directory_iterator(folder)) fs::remove_all(left.path());
      record = Ended(ClipStatus::kNothingToTrack, nothing.what());
    }
    record.id = clip.id;
    record.verb = VerbOf(clip);
    record.seconds = watch.seconds();
    record.version = BODYLOOM_VERSION;
    return record;
  }

  /// Moves the folder to the results, with the record in it.
  void Keep(const BatchClip& clip, ClipRecord* record, WorkPlace* place) {
    record->files = ResultFilesOf(place->folder());
    WriteFileAtomically(place->folder() + "/" + kClipRecordFile, ToJson(*record));
    place->MoveFolderTo(ClipFolder(request_.out, clip.id));
    ForgetFailure(clip);
  }

  void ForgetFailure(const BatchClip& clip) const {
    std::error_code ignored;
    fs::remove(FailureFile(request_.out, clip.id), ignored);
  }

  /// A failed clip's record, kept where that is possible.
  ClipRecord Failure(const BatchClip& clip, const std::string& hash, const std::string& reason) {
    ClipRecord record = Ended(ClipStatus::kFailed, reason);
    record.id = clip.id;
    record.verb = VerbOf(clip);
    record.hash = hash;
    record.version = BODYLOOM_VERSION;
    try {
      WorkPlace place(BatchWorkFolder(request_.out), clip.id);
      WriteFileAtomically(place.folder() + "/failure.json", ToJson(record));
      place.MoveFileTo("failure.json", FailureFile(request_.out, clip.id));
    } catch (const std::runtime_error&) {  // it is told of in any case
    }
    return record;
  }

  std::string WhyStopped() {
    const std::unique_lock<std::mutex> hold(mutex_);
    return why_stopped_.empty() ? "interrupted" : why_stopped_;
  }

  const RunBatchRequest& request_;
  const BatchCallbacks& callbacks_;
  std::mutex mutex_;  ///< of all below, and held during callbacks
  std::deque<Turn> waiting_;
  std::vector<double> parts_;  ///< of each clip, how much is done
  std::string why_stopped_;
  std::map<ClipStatus, int> counts_;
  int ended_ = 0;
};

}  // namespace

std::string ClipFolder(const std::string& out, const std::string& id) {
  return (fs::path(out) / "clips" / id).string();
}
std::string FailureFile(const std::string& out, const std::string& id) {
  return (fs::path(out) / "failures" / (id + ".json")).string();
}
std::string BatchManifestFile(const std::string& out) { return (fs::path(out) / "manifest.jsonl").string(); }
std::string BatchWorkFolder(const std::string& out) { return (fs::path(out) / ".work").string(); }

int RunBatchReport::Count(ClipStatus status) const {
  const auto found = clips.find(status);
  return found == clips.end() ? 0 : found->second;
}

std::string ToText(const RunBatchReport& report) {
  int all = 0;
  for (const auto& [status, count] : report.clips) all += count;
  return Concatenate(all, all == 1 ? " clip: " : " clips: ", report.Count(ClipStatus::kDone), " done, ",
                     report.Count(ClipStatus::kSkipped), " done before, ", report.Count(ClipStatus::kNothingToTrack),
                     " with nothing to track, ", report.Count(ClipStatus::kFailed), " failed, ",
                     report.Count(ClipStatus::kRetry), " to be tried again; ", Fixed(report.seconds, 1), " s");
}

RunBatchReport RunBatch(const RunBatchRequest& request, const BatchCallbacks& callbacks) {
  BODYLOOM_CHECK(request.jobs >= 1 && request.jobs <= kMostJobs, request.jobs, " clips at once, expected 1 to ",
                 kMostJobs);
  Stopwatch watch;
  std::error_code error;
  fs::create_directories(request.out, error);
  if (!fs::is_directory(request.out)) {
    throw std::runtime_error(request.out + ": cannot be made a folder" + (error ? " (" + error.message() + ")" : ""));
  }
  KeepManifest(request);
  Batch batch(request, callbacks);
  std::vector<std::jthread> others;
  const int jobs = std::min(request.jobs, std::max(1, static_cast<int>(request.clips.size())));
  for (int i = 1; i < jobs; ++i) others.emplace_back([&batch] { batch.Work(); });
  batch.Work();
  others.clear();  // joins
  RemoveStalePlaces(BatchWorkFolder(request.out));
  return {batch.counts(), watch.seconds()};
}

}  // namespace bodyloom
