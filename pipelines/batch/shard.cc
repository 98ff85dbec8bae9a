// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/shard.h"

#include <charconv>
#include <string_view>

#include "bodyloom/data_tools/formats/printable.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {
namespace {

constexpr int kMostShards = 1'000'000;

std::optional<int> WholeNumber(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

int SlurmNumber(const std::string& name, const char* value) {
  const std::optional<int> number = WholeNumber(value);
  if (!number) throw RequestError(name + " is '" + PrintableText(value) + "', expected a whole number");
  return *number;
}

}  // namespace

Shard ShardFromText(const std::string& text) {
  const size_t slash = text.find('/');
  const std::string_view whole = text;
  if (slash != std::string::npos) {
    const std::optional<int> index = WholeNumber(whole.substr(0, slash)), count = WholeNumber(whole.substr(slash + 1));
    if (index && count && *count <= kMostShards && *index < *count) return {*index, *count};
  }
  throw RequestError("--shard '" + PrintableText(text) + "', expected i/N with i from 0 to N - 1, as in 0/6 to 5/6");
}

std::optional<Shard> ShardFromSlurm(const std::function<const char*(const char*)>& variable) {
  const auto number = [&](const std::string& name, int otherwise) {
    const char* value = variable(name.c_str());
    return value == nullptr ? otherwise : SlurmNumber(name, value);
  };
  if (variable("SLURM_ARRAY_TASK_ID") == nullptr || variable("SLURM_ARRAY_TASK_COUNT") == nullptr) return std::nullopt;
  const int id = number("SLURM_ARRAY_TASK_ID", 0), count = number("SLURM_ARRAY_TASK_COUNT", 0);
  const int least = number("SLURM_ARRAY_TASK_MIN", 0), step = number("SLURM_ARRAY_TASK_STEP", 1);
  const int most = number("SLURM_ARRAY_TASK_MAX", least + step * (count - 1));
  const bool even = count > 0 && count <= kMostShards && step > 0 && id >= least && id <= most &&
                    (id - least) % step == 0 && (most - least) / step == count - 1;
  if (!even) {
    throw RequestError("task " + std::to_string(id) + " of a Slurm array of " + std::to_string(count) +
                       " tasks whose numbers are not evenly spaced from " + std::to_string(least) + " by " +
                       std::to_string(step) + ": give --shard i/N");
  }
  return Shard{(id - least) / step, count};
}

Shard ChooseShard(const std::string& text, const std::function<const char*(const char*)>& variable) {
  return text.empty() ? ShardFromSlurm(variable).value_or(Shard()) : ShardFromText(text);
}

}  // namespace bodyloom
