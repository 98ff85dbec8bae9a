// SPDX-License-Identifier: Apache-2.0
#include "pipelines/batch/run_batch.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>

#include "data_tools/formats/atomic_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRecordFile = "clip.json";
constexpr int kMaxTableWrites = 3;

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  errno = error.value();
  if (error) ThrowSystemError(folder.string(), "make the folder");
}

/// Removed with all that is in it.
struct TemporaryFolder {
  std::string path;
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// A record that cannot be read is that of a clip that failed.
ClipRecord RecordIn(const std::string& path, const std::string& id) {
  ClipRecord failed;
  failed.id = id;
  try {
    ClipRecord record = ClipRecordFromText(ReadFileBytes(path), path);
    if (record.id == id) return record;
    failed.reason = path + ": the record of another clip";
  } catch (const std::runtime_error& error) {
    failed.reason = error.what();
  }
  return failed;
}

class Batch {
 public:
  Batch(const RunBatchRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks), out_(request.out) {}

  std::map<ClipStatus, int> Run() {
    ParallelFor(static_cast<int>(request_.clips.size()), request_.jobs, [this](int i) {
      if (!ReportProgress(0)) return;
      try {
        const ClipRecord record = RunClip(request_.clips[static_cast<size_t>(i)]);
        const std::lock_guard<std::mutex> hold(mutex_);
        ++counts_[record.status];
        ++ended_;
        if (request_.on_ended) request_.on_ended(record);
      } catch (...) {
        const std::lock_guard<std::mutex> hold(mutex_);
        if (!stopped_by_) stopped_by_ = std::current_exception();
      }
    });
    if (stopped_by_) std::rethrow_exception(stopped_by_);
    return counts_;
  }

  /// Empty while a clip has not ended.
  [[nodiscard]] std::string Table() const {
    std::vector<ClipRecord> records;
    for (const std::string& id : request_.ids_of_table) {
      const bool failed = fs::exists(Failure(id));
      if (!failed && !fs::exists(Clip(id))) return "";
      records.push_back(RecordIn(failed ? Failure(id) : Record(id), id));
    }
    return ToCsv(records);
  }

 private:
  [[nodiscard]] fs::path Clip(const std::string& id) const { return out_ / "clips" / id; }
  [[nodiscard]] std::string Record(const std::string& id) const { return (Clip(id) / kRecordFile).string(); }
  [[nodiscard]] std::string Failure(const std::string& id) const { return (out_ / "failed" / (id + ".json")).string(); }
  [[nodiscard]] fs::path WorkFolder() const { return out_ / ".work"; }

  bool ReportProgress(double fraction_of_clip) {
    const std::lock_guard<std::mutex> hold(mutex_);
    const size_t all = request_.clips.size();
    const double whole = (ended_ + fraction_of_clip) / static_cast<double>(all);
    if (!stopped_by_ && !callbacks_.ReportProgress(Concatenate(ended_, " of ", all), whole)) {
      stopped_by_ = std::make_exception_ptr(Cancelled());
    }
    return !stopped_by_;
  }

  /// Record of a clip that an earlier or concurrent run has finished; empty if there is none.
  [[nodiscard]] std::optional<ClipRecord> Done(const std::string& id, const std::string& hash) const {
    ClipRecord record = RecordIn(Record(id), id);
    if (record.hash != hash || hash.empty()) return std::nullopt;
    if (record.status == ClipStatus::kDone) record.status = ClipStatus::kSkipped;
    ClearUp(id);
    return record;
  }

  /// Of a clip that is done: the record of its failure goes, and what killed runs were writing.
  void ClearUp(const std::string& id) const {
    std::error_code ignored;
    fs::remove(Failure(id), ignored);
    for (fs::directory_iterator at(WorkFolder(), ignored), end; at != end; at.increment(ignored)) {
      if (!at->path().filename().string().starts_with(id + "~")) continue;
      // Renamed first: should its run live, it moves nothing into place that is half removed.
      const std::string gone = at->path().string() + "~";
      ::rename(at->path().c_str(), gone.c_str());
      fs::remove_all(gone, ignored);
    }
  }

  ClipRecord RunClip(const BatchClip& clip) {
    std::string hash;
    try {
      hash = ClipHash(clip, BODYLOOM_VERSION);
      if (const std::optional<ClipRecord> done = Done(clip.id, hash)) return *done;
      MakeFolder(WorkFolder());
      // Another one for each run; '~' is in no id.
      TemporaryFolder temporary{(WorkFolder() / (clip.id + "~XXXXXX")).string()};
      if (::mkdtemp(temporary.path.data()) == nullptr) ThrowSystemError(temporary.path, "make the folder");
      const std::string finished = temporary.path + "/finished";
      MakeFolder(finished);
      PipelineCallbacks callbacks;
      callbacks.progress = [this](const std::string&, double fraction) { return ReportProgress(fraction); };
      callbacks.message = [&](const std::string& line) {
        const std::lock_guard<std::mutex> hold(mutex_);
        callbacks_.Message(clip.id + ": " + line);
      };
      const Stopwatch watch;
      ClipRecord record = TrackBatchClip(clip, finished, callbacks);
      record.seconds = watch.seconds();
      record.hash = hash;
      WriteFileAtomically(finished + "/" + kRecordFile, ToLine(record) + "\n");
      return MoveIntoPlace(finished, temporary.path + "/replaced", record);
    } catch (const Cancelled&) {
      throw;
    } catch (const DiskFullError&) {
      throw;
    } catch (const std::exception& error) {
      if (!ReportProgress(1)) throw;  // what fails upon Ctrl-C is not the clip's fault
      if (const std::optional<ClipRecord> done = Done(clip.id, hash)) return *done;  // by a run that has cleared up
      ClipRecord record;
      record.id = clip.id;
      record.verb = VerbOf(clip);
      record.reason = error.what();
      MakeFolder(out_ / "failed");
      WriteFileAtomically(Failure(clip.id), ToLine(record) + "\n");
      return record;
    }
  }

  /// Older results are replaced; the same of another run, which has come first, stay.
  [[nodiscard]] ClipRecord MoveIntoPlace(const std::string& finished, const std::string& replaced,
                                         const ClipRecord& record) const {
    const std::string target = Clip(record.id).string();
    MakeFolder(out_ / "clips");
    if (::rename(finished.c_str(), target.c_str()) != 0) {
      if (const std::optional<ClipRecord> first = Done(record.id, record.hash)) return *first;
      ::rename(target.c_str(), replaced.c_str());
      if (::rename(finished.c_str(), target.c_str()) != 0) ThrowSystemError(target, "move the finished folder here");
    }
    ClearUp(record.id);
    return record;
  }

  const RunBatchRequest& request_;
  const PipelineCallbacks& callbacks_;
  const fs::path out_;
  std::mutex mutex_;  ///< of all below, and held during callbacks
  std::map<ClipStatus, int> counts_;
  int ended_ = 0;
  std::exception_ptr stopped_by_;
};

}  // namespace

std::string ToText(const RunBatchReport& report) {
  std::string text;
  for (const auto& [status, count] : report.clips) {
    text += Concatenate(count, " ", kClipStatusNames[static_cast<size_t>(status)], ", ");
  }
  return text + (report.table.empty() ? "no table yet: clips of other shards are missing" : "table: " + report.table);
}

RunBatchReport RunBatch(const RunBatchRequest& request, const PipelineCallbacks& callbacks) {
  MakeFolder(request.out);
  Batch batch(request, callbacks);
  RunBatchReport report;
  report.clips = batch.Run();
  const std::string path = (fs::path(request.out) / "clips.csv").string();
  std::string table = batch.Table(), written = fs::exists(path) ? ReadFileBytes(path) : "";
  if (!table.empty()) report.table = path;
  // Read again once it is written: another run may have put a clip into place meanwhile, and its table before this one.
  for (int i = 0; i < kMaxTableWrites && !table.empty() && table != written; ++i) {
    WriteFileAtomically(path, table);
    written = table;
    table = batch.Table();
  }
  return report;
}

}  // namespace bodyloom
