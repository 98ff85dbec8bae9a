// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/pickle.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/inflate.h"
#include "data_tools/formats/pickle_machine.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Keeps the last value of each key, at the place of the first.
void MergeEqualKeys(PickleNode* node) {
  if (node->dict.size() < 2) return;
  std::unordered_map<std::string_view, size_t> place;
  std::vector<size_t> value_of;  // kept entry -> the entry its value comes from
  std::vector<size_t> kept;
  for (size_t i = 0; i < node->dict.size(); ++i) {
    const auto [it, is_new] = place.try_emplace(node->dict[i].first, kept.size());
    if (is_new) {
      kept.push_back(i);
      value_of.push_back(i);
    } else {
      value_of[it->second] = i;
    }
  }
  if (kept.size() == node->dict.size()) return;
  std::vector<std::pair<std::string, PicklePtr>> merged;
  for (size_t k = 0; k < kept.size(); ++k)
    merged.emplace_back(node->dict[kept[k]].first, node->dict[value_of[k]].second);
  node->dict = std::move(merged);
}

/// Visits everything the result holds: copies text out of the file, merges repeated keys, measures depth, refuses
/// cycles. Iterative, so that a hostile depth cannot exhaust the call stack.
void Finish(PickleNode* root, int max_depth, PickleContext* context) {
  struct Step {
    PickleNode* node;
    size_t next;
  };
  std::vector<Step> path;
  const auto enter = [&](PickleNode* node) {
    node->visit = 1;
    node->height = 1;
    if (node->view.data() != nullptr) {
      context->Charge(node->view.size());
      node->text = std::string(node->view);
      node->view = {};
    }
    MergeEqualKeys(node);
    path.push_back({node, 0});
  };
  enter(root);
  while (!path.empty()) {
    PickleNode* node = path.back().node;
    const size_t next = path.back().next++;
    if (next < node->items.size() + node->dict.size()) {
      const PicklePtr& child_value =
          next < node->items.size() ? node->items[next] : node->dict[next - node->items.size()].second;
      auto* child = const_cast<PickleNode*>(&AsNode(child_value));  // made by New, not const there
      if (child->visit == 1) context->Fail("a value that contains itself");
      if (child->visit == 0) enter(child);
      node->height = std::max(node->height, child->height + 1);
      if (path.size() > static_cast<size_t>(max_depth)) {
        context->Fail(Concatenate("values nested more than ", max_depth, " levels deep"));
      }
      continue;
    }
    node->visit = 2;
    path.pop_back();
    if (!path.empty()) path.back().node->height = std::max(path.back().node->height, node->height + 1);
    if (node->height > max_depth) context->Fail(Concatenate("values nested more than ", max_depth, " levels deep"));
  }
}

/// Cuts the links of all nodes that the result does not hold (all of them when reading failed), so that the destructors
/// meet neither cycles nor very deep chains.
void Release(PickleContext* context, bool keep_result) {
  for (const PickleNodePtr& node : context->nodes) {
    if (keep_result && node->visit == 2) continue;
    node->items.clear();
    node->dict.clear();
  }
  context->nodes.clear();
}

}  // namespace

const PickleValue* PickleValue::Find(const std::string& key) const {
  for (auto it = dict.rbegin(); it != dict.rend(); ++it) {
    if (it->first == key) return it->second.get();
  }
  return nullptr;
}

const NdArray& RequireNumbers(const PickleValue& file, const std::string& key, const std::string& where) {
  const PickleValue* value = file.Find(key);
  if (value == nullptr || value->kind != PickleValue::Kind::kArray || !value->array.is_number()) {
    throw std::runtime_error(where + ": no array '" + key + "'");
  }
  return value->array;
}

void PickleContext::Fail(const std::string& message) const {
  throw std::runtime_error(Concatenate(where_, ": byte ", offset, ": ", message));
}

void PickleContext::Charge(size_t bytes) {
  if (bytes > budget_) Fail("the pickle needs more memory than is allowed for a file of its size");
  budget_ -= bytes;
}

PickleNodePtr PickleContext::New(PickleValue::Kind kind) {
  if (nodes.size() >= max_items_) Fail(Concatenate("more than ", max_items_, " values"));
  Charge(sizeof(PickleNode) + 64);
  PickleNodePtr node = std::make_shared<PickleNode>();
  node->kind = kind;
  nodes.push_back(node);
  return node;
}

PicklePtr ReadPickle(const std::string& bytes, const std::string& where, const PickleLimits& limits) {
  size_t offset = 0;
  if (LooksLikeGzip(bytes) || LooksLikeZlib(bytes)) {
    return ReadPickleAt(PickleDialect::kPlain, Inflate(bytes, where, limits.max_bytes), &offset, where, limits);
  }
  return ReadPickleAt(PickleDialect::kPlain, bytes, &offset, where, limits);
}

PicklePtr ReadPickleAt(PickleDialect dialect, std::string_view bytes, size_t* offset, const std::string& where,
                       const PickleLimits& limits) {
  // Memory in proportion to the file: a few bytes can request much (memo references, sparse matrices).
  constexpr size_t kFloor = size_t{64} << 20, kPerByte = 256;
  const size_t budget = std::min(limits.max_bytes, kFloor + kPerByte * bytes.size());
  PickleContext context(dialect, where, budget, limits.max_items);
  context.offset = *offset;
  try {
    PickleNodePtr root = RunPickle(bytes, &context);
    Finish(root.get(), limits.max_depth, &context);
    Release(&context, true);
    *offset = context.offset + 1;
    return root;
  } catch (...) {
    Release(&context, false);
    throw;
  }
}

PicklePtr ReadPickleFile(const std::string& path, const PickleLimits& limits) {
  return ReadPickle(ReadFileBytes(path), path, limits);
}

}  // namespace bodyloom
