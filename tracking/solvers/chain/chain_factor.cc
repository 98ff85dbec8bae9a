// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/chain/chain_factor.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "tracking/problem/panel_simd.h"

namespace bodyloom {

using panel_internal::Products;
using panel_internal::RoundUp;

/// A frame's rows while it is being eliminated: [A | coupling to the next | arrow, right-hand side | coupling to the
/// one after]. "Next" is t + 1 in forward direction and t − 1 in backward direction.
struct ChainFactor::Panel {
  int64_t stride = 0;
  int next = 0, arrow = 0, second = 0;  ///< first columns of the sections
  std::vector<double> memory;
  double* data = nullptr;  ///< aligned to a cache line

  Panel(int n, int b_columns) {
    next = RoundUp(n);
    arrow = 2 * RoundUp(n);
    second = arrow + b_columns;
    stride = panel_internal::RowStride(second + RoundUp(n));
    memory.assign(static_cast<size_t>(n * stride) + 16, 0.0);
    data = memory.data();
    while (reinterpret_cast<uintptr_t>(data) % 64 != 0) ++data;
  }
  Panel(Panel&&) = default;
  Panel& operator=(Panel&&) = default;
  void Clear() { std::fill(memory.begin(), memory.end(), 0.0); }
  [[nodiscard]] size_t size() const { return memory.size() - 16; }
  void CopyTo(std::vector<double>* values) const { values->assign(data, data + size()); }
  void CopyFrom(const std::vector<double>& values) { std::copy(values.begin(), values.end(), data); }
};

/// Frames eliminated one after the other in one direction.
struct ChainFactor::Half {
  int begin = 0, count = 0, direction = 1;
  int first_kept = 0;  ///< the rows of the frames before it, in the order of elimination, are computed again
  bool ok = true;
  std::vector<Panel>* panels = nullptr;  ///< current, next, second; afterwards the system of the two middle frames
  std::vector<double> shared_sum;        ///< (s+1 rounded up)²: minus the arrow's products
  /// Panels of the current and the next frame before each kBlock-th frame up to first_kept.
  std::vector<std::array<std::vector<double>, 2>> checkpoints;
  [[nodiscard]] int FrameAt(int i) const { return begin + i * direction; }
};

namespace {

void AddBlocks(const double* blocks, int n, bool transposed, double* target, int64_t stride) {
  for (int i = 0; i < n; i += 3, blocks += 9) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) target[(i + r) * stride + i + c] += blocks[transposed ? 3 * c + r : 3 * r + c];
    }
  }
}

void AddDense(const double* block, int n, bool transposed, double* target, int64_t stride) {
  if (block == nullptr) return;
  for (int i = 0; i < n; ++i, target += stride) {
    for (int j = 0; j < n; ++j) target[j] += transposed ? block[j * n + i] : block[i * n + j];
  }
}

}  // namespace

ChainFactor::ChainFactor(int frame_size, int shared_size, std::vector<char> cut_before, int num_multipliers,
                         int max_kept)
    : n_(frame_size),
      s_(shared_size),
      num_multipliers_(num_multipliers),
      max_kept_(max_kept),
      b_columns_(RoundUp(shared_size + 1)),
      cut_before_(std::move(cut_before)) {
  BODYLOOM_CHECK(n_ > 0 && n_ % 3 == 0 && s_ >= 0 && !cut_before_.empty(), "chain: ", cut_before_.size(), " frames of ",
                 n_, " values and ", s_, " shared ones; expected at least one frame of a multiple of 3");
  factor_.resize(cut_before_.size());
}

ChainFactor::~ChainFactor() = default;

void ChainFactor::SetCuts(std::vector<char> cut_before) {
  BODYLOOM_CHECK(!cut_before.empty(), "chain: no frames");
  cut_before_ = std::move(cut_before);
  frozen_.clear();
  factor_.resize(cut_before_.size());
}

void ChainFactor::SetFrozen(std::vector<char> frozen) {
  BODYLOOM_CHECK(frozen.empty() || frozen.size() == cut_before_.size(), "chain: frozen marks for ", frozen.size(),
                 " frames, expected ", cut_before_.size(), " or none");
  for (size_t t = 1; t + 1 < frozen.size(); ++t) {
    BODYLOOM_CHECK(frozen[t] == 0 || frozen[t - 1] != 0 || frozen[t + 1] != 0, "chain: frame ", t,
                   " would be frozen alone");
  }
  frozen_ = std::move(frozen);
}

bool ChainFactor::Step(Panel* front, Panel* next, Panel* second, std::vector<double>* shared_sum,
                       std::vector<double>* rows) const {
  if (!panel_internal::EliminateRows(front->data, front->stride, n_, RoundUp(n_) + b_columns_, second != nullptr)) {
    return false;
  }
  const double* w1 = front->data + front->next;
  const double* y = front->data + front->arrow;
  const double* w2 = front->data + front->second;
  Products p;
  p.lda = p.ldb = front->stride;
  p.last = n_;
  p.sign = -1;
  const auto add = [&](const double* a, const double* b, double* c, int64_t c_stride, int rows, int columns, bool upper,
                       bool lower) {
    p.a = a;
    p.b = b;
    p.c = c;
    p.ldc = c_stride;
    p.rows = rows;
    p.columns = columns;
    p.upper = upper;
    p.b_lower = lower;
    panel_internal::AddProducts(p);
  };
  if (next != nullptr) {
    add(w1, w1, next->data, next->stride, n_, n_, true, false);
    add(w1, y, next->data + next->arrow, next->stride, n_, b_columns_, false, false);
  }
  if (second != nullptr) {
    add(w1, w2, next->data + next->next, next->stride, n_, n_, false, true);
    add(w2, w2, second->data, second->stride, n_, n_, true, true);
    add(w2, y, second->data + second->arrow, second->stride, n_, b_columns_, false, false);
  }
  add(y, y, shared_sum->data(), b_columns_, b_columns_, b_columns_, true, false);
  if (rows != nullptr) Store(*front, rows);
  return true;
}

void ChainFactor::Store(const Panel& front, std::vector<double>* rows) const {
  std::vector<double>& out = *rows;
  size_t size = 0;
  for (int k = 0; k < n_; ++k) size += static_cast<size_t>(n_ - k + n_ + s_ + 1 + k / 3 * 3 + 3);
  out.resize(size);
  double* next = out.data();
  for (int k = 0; k < n_; ++k) {
    const double* row = front.data + k * front.stride;
    next = std::copy(row + k, row + n_, next);
    next = std::copy(row + front.next, row + front.next + n_, next);
    next = std::copy(row + front.arrow, row + front.arrow + s_ + 1, next);
    next = std::copy(row + front.second, row + front.second + k / 3 * 3 + 3, next);
  }
}

void ChainFactor::AddToFront(const ChainSource& source, int t, int direction, Panel* front) const {
  const bool back = direction < 0;
  source.AddFrame(t, front->data, front->stride, front->data + front->arrow, front->stride);
  AddBlocks(source.Next(back ? t - 1 : t), n_, back, front->data + front->next, front->stride);
  AddBlocks(source.Second(back ? t - 2 : t), n_, back, front->data + front->second, front->stride);
  AddDense(source.DenseNext(back ? t - 1 : t), n_, back, front->data + front->next, front->stride);
}

bool ChainFactor::Eliminate(const ChainSource& source, Half* half) {
  std::vector<Panel>& panels = *half->panels;
  while (panels.size() < 3) panels.emplace_back(n_, b_columns_);
  for (Panel& panel : panels) panel.Clear();
  half->shared_sum.assign(static_cast<size_t>(b_columns_) * b_columns_, 0.0);
  half->checkpoints.resize((half->first_kept + kBlock - 1) / kBlock);
  for (int i = 0; i < half->count; ++i) {
    const bool kept = i >= half->first_kept;
    if (!kept && i % kBlock == 0) {
      for (int k = 0; k < 2; ++k) panels[k].CopyTo(&half->checkpoints[i / kBlock][k]);
    }
    const int t = half->FrameAt(i);
    AddToFront(source, t, half->direction, &panels[0]);
    if (!Step(&panels[0], &panels[1], &panels[2], &half->shared_sum, kept ? &factor_[t] : nullptr)) return false;
    std::rotate(panels.begin(), panels.begin() + 1, panels.end());
    panels[2].Clear();
  }
  return true;
}

void ChainFactor::VisitRows(int h, const std::function<bool(int, const std::vector<double>&)>& visit) const {
  const Half& half = halves_[h];
  int i = half.count - 1;
  for (; i >= half.first_kept; --i) {
    if (!visit(half.FrameAt(i), factor_[half.FrameAt(i)])) return;
  }
  if (i < 0) return;
  std::vector<Panel> panels;
  while (panels.size() < 3) panels.emplace_back(n_, b_columns_);
  std::vector<std::vector<double>> rows(kBlock);
  std::vector<double> shared_sum(static_cast<size_t>(b_columns_) * b_columns_);  // was taken the first time
  while (i >= 0) {
    const int first = i / kBlock * kBlock;
    for (int k = 0; k < 2; ++k) panels[k].CopyFrom(half.checkpoints[i / kBlock][k]);
    panels[2].Clear();
    for (int k = first; k <= i; ++k) {
      AddToFront(*source_, half.FrameAt(k), half.direction, &panels[0]);
      Step(&panels[0], &panels[1], &panels[2], &shared_sum, &rows[k - first]);
      std::rotate(panels.begin(), panels.begin() + 1, panels.end());
      panels[2].Clear();
    }
    for (; i >= first; --i) {
      if (!visit(half.FrameAt(i), rows[i - first])) return;
    }
  }
}

bool ChainFactor::EliminateMiddle(const ChainSource& source, const Segment& segment, Half* forward, Half* backward,
                                  std::vector<double>* shared_sum) {
  shared_sum->assign(static_cast<size_t>(b_columns_) * b_columns_, 0.0);
  const bool two = segment.end - segment.begin >= 2;
  while (middle_panels_.size() < 2) middle_panels_.emplace_back(n_, b_columns_);
  Panel &first = middle_panels_[0], &last = middle_panels_[1];
  first.Clear();
  last.Clear();
  const auto add = [&](const Panel& from, Panel* to, bool coupling) {
    for (int i = 0; i < n_; ++i) {
      const double* x = from.data + i * from.stride;
      double* y = to->data + i * to->stride;
      for (int j = i; j < n_; ++j) y[j] += x[j];
      for (int j = 0; j < b_columns_; ++j) y[to->arrow + j] += x[from.arrow + j];
      if (!coupling) continue;
      for (int j = 0; j < n_; ++j) y[to->next + j] += x[from.next + j];
    }
  };
  const int m = segment.middle;
  source.AddFrame(m, first.data, first.stride, first.data + first.arrow, first.stride);
  if (two) {
    source.AddFrame(m + 1, last.data, last.stride, last.data + last.arrow, last.stride);
    AddBlocks(source.Next(m), n_, false, first.data + first.next, first.stride);
    AddDense(source.DenseNext(m), n_, false, first.data + first.next, first.stride);
  }
  if (forward->count > 0) {
    add((*forward->panels)[0], &first, true);
    add((*forward->panels)[1], &last, false);
  }
  if (backward->count > 0) {
    add((*backward->panels)[0], &last, false);
    add((*backward->panels)[1], &first, false);
    const Panel& from = (*backward->panels)[0];
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) {
        first.data[j * first.stride + first.next + i] += from.data[i * from.stride + from.next + j];
      }
    }
  }
  if (!Step(&first, two ? &last : nullptr, nullptr, shared_sum, &factor_[m])) return false;
  return !two || Step(&last, nullptr, nullptr, shared_sum, &factor_[m + 1]);
}

void ChainFactor::BackSubstitute(int t, const std::vector<double>& rows, int next, int second, const double* shared,
                                 double* frames) const {
  const double* row = rows.data() + rows.size();
  double* x = frames + static_cast<int64_t>(t) * n_;
  for (int k = n_ - 1; k >= 0; --k) {
    const int lower = k / 3 * 3 + 3;
    row -= n_ - k + n_ + s_ + 1 + lower;
    const double* w1 = row + (n_ - k);
    const double* y = w1 + n_;
    double value = y[s_];
    for (int i = 0; i < s_; ++i) value -= y[i] * shared[i];
    if (next >= 0) value -= panel_internal::Dot(w1, frames + static_cast<int64_t>(next) * n_, n_);
    if (second >= 0) value -= panel_internal::Dot(y + s_ + 1, frames + static_cast<int64_t>(second) * n_, lower);
    value -= panel_internal::Dot(row + 1, x + k + 1, n_ - k - 1);
    x[k] = value / row[0];
  }
}

std::vector<ChainFactor::Segment> ChainFactor::Segments() const {
  std::vector<Segment> segments;
  const auto is_frozen = [&](int t) { return !frozen_.empty() && frozen_[t] != 0; };
  for (int t = 0; t < num_frames(); ++t) {
    if (is_frozen(t)) continue;
    if (t == 0 || cut_before_[t] || is_frozen(t - 1)) segments.emplace_back().begin = t;
    segments.back().end = t + 1;
  }
  for (Segment& segment : segments) {
    segment.middle = segment.begin + std::max(0, (segment.end - segment.begin - 2) / 2);
  }
  return segments;
}

std::vector<ChainFactor::Half> ChainFactor::HalvesOf(const std::vector<Segment>& segments) const {
  std::vector<Half> halves;
  for (const Segment& segment : segments) {
    Half& forward = halves.emplace_back();
    forward.begin = segment.begin;
    forward.count = segment.middle - segment.begin;
    Half& backward = halves.emplace_back();
    backward.begin = segment.end - 1;
    backward.direction = -1;
    backward.count = std::max(0, segment.end - segment.middle - 2);
  }
  return halves;
}

void ChainFactor::PlanMemory() {
  const int share = max_kept_ / std::max<int>(1, static_cast<int>(halves_.size()));
  int left = max_kept_;
  for (Half& half : halves_) {
    half.first_kept = std::max(0, half.count - share);
    left -= half.count - half.first_kept;
  }
  for (Half& half : halves_) {
    const int more = std::min(half.first_kept, left);
    half.first_kept -= more;
    left -= more;
    for (int i = 0; i < half.first_kept; ++i) factor_[half.FrameAt(i)] = {};
  }
}

bool ChainFactor::Solve(const ChainSource& source, const Eigen::MatrixXd& shared, const Eigen::VectorXd& shared_rhs,
                        int num_threads, Eigen::VectorXd* frames, Eigen::VectorXd* shared_step) {
  const int T = num_frames();
  const std::vector<Segment> segments = Segments();
  halves_ = HalvesOf(segments);
  source_ = &source;
  PlanMemory();
  std::vector<Half>& halves = halves_;
  Eigen::MatrixXd S = shared.selfadjointView<Eigen::Lower>();
  Eigen::VectorXd rhs = shared_rhs;
  const auto subtract = [&](const std::vector<double>& sum) {
    if (sum.empty()) return;
    for (int i = 0; i < s_; ++i) {
      for (int j = i; j < s_; ++j) S(j, i) += sum[i * b_columns_ + j];
      rhs[i] += sum[i * b_columns_ + s_];
    }
  };
  constexpr int kAtOnce = 8;  // segments whose panels are in memory at the same time
  const int num_segments = static_cast<int>(segments.size());
  std::vector<double> middle_sum;
  panels_.resize(std::max(panels_.size(), static_cast<size_t>(2 * std::min(kAtOnce, num_segments))));
  for (int first = 0; first < num_segments; first += kAtOnce) {
    const int last = std::min(first + kAtOnce, num_segments);
    ParallelFor(2 * (last - first), num_threads, [&](int i) {
      Half& half = halves[2 * first + i];
      half.panels = &panels_[i];
      if (half.count > 0) half.ok = Eliminate(source, &half);
    });
    for (int i = first; i < last; ++i) {
      Half &forward = halves[2 * i], &backward = halves[2 * i + 1];
      if (!forward.ok || !backward.ok || !EliminateMiddle(source, segments[i], &forward, &backward, &middle_sum)) {
        return false;
      }
      subtract(forward.shared_sum);
      subtract(backward.shared_sum);
      subtract(middle_sum);
    }
  }
  shared_step->setZero(s_);
  if (s_ > 0 && frozen_.empty()) {
    if (num_multipliers_ > 0) {
      const Eigen::PartialPivLU<Eigen::MatrixXd> factor(S.selfadjointView<Eigen::Lower>().toDenseMatrix());
      *shared_step = factor.solve(rhs);
      shared_inverse_ = factor.inverse();
    } else {
      const Eigen::LLT<Eigen::MatrixXd> factor(S);
      if (factor.info() != Eigen::Success) return false;
      *shared_step = factor.solve(rhs);
      shared_inverse_ = factor.solve(Eigen::MatrixXd::Identity(s_, s_));
    }
  }
  frames->resize(static_cast<int64_t>(T) * n_);
  if (!frozen_.empty()) frames->setZero();
  const double* y = shared_step->data();
  double* x = frames->data();
  for (const Segment& segment : segments) {
    if (segment.end - segment.begin >= 2) {
      BackSubstitute(segment.middle + 1, factor_[segment.middle + 1], -1, -1, y, x);
      BackSubstitute(segment.middle, factor_[segment.middle], segment.middle + 1, -1, y, x);
    } else {
      BackSubstitute(segment.middle, factor_[segment.middle], -1, -1, y, x);
    }
  }
  ParallelFor(static_cast<int>(halves.size()), num_threads, [&](int h) {
    const int direction = halves[h].direction;
    VisitRows(h, [&](int t, const std::vector<double>& rows) {
      BackSubstitute(t, rows, t + direction, t + 2 * direction, y, x);
      return true;
    });
  });
  return frames->allFinite() && shared_step->allFinite();
}

}  // namespace bodyloom
