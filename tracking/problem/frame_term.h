// SPDX-License-Identifier: Apache-2.0
/// Interface of the terms of a frame's cost, built-in and users', and the list that holds them.
///
/// A term holds its observations of one frame and adds ½ Σ w ρ(‖r‖²) of its residuals, with their derivatives, to the
/// sums of the frame (frame_accumulator.h). Engines, plan and reports use terms by this interface only; the formula of
/// each is in its own header.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace bodyloom {

class FrameAccumulator;

/// Settings of a stage of the solve (track_stages.h).
struct StageSettings {
  double initialiser_weight = 0;  ///< λ_d of terms/initialiser.h
  double landmark_kernel = 4;     ///< c of terms/landmarks.h, in σ
};

class FrameTerm {
 public:
  virtual ~FrameTerm() = default;
  /// Name in the table of costs, as "2D joints".
  [[nodiscard]] virtual std::string name() const = 0;
  /// Maximum number of rows of the Jacobian that Add() fills, without those that it adds to the sums directly.
  [[nodiscard]] virtual int num_rows() const { return 0; }
  /// True if the term has no observations of this frame and so adds nothing at any state.
  [[nodiscard]] virtual bool is_empty() const { return num_rows() == 0; }
  /// True if an engine that takes residuals one by one (Ceres) gets those of this frame compressed into a square-root
  /// system, because there are thousands, or because the unknowns that they depend on change with the state.
  [[nodiscard]] virtual bool is_compressed() const { return false; }
  /// Adds the term's cost and, if derivatives are requested, its rows. Called from several threads.
  virtual void Add(FrameAccumulator* sums) const = 0;
  virtual void BeginStage(const StageSettings& /*settings*/) {}
  [[nodiscard]] virtual std::unique_ptr<FrameTerm> Clone() const = 0;

 protected:
  FrameTerm() = default;
  FrameTerm(const FrameTerm&) = default;
  FrameTerm& operator=(const FrameTerm&) = default;
};

/// Base of a term that is copied member by member.
template <typename Term>
class CopyableTerm : public FrameTerm {
 public:
  [[nodiscard]] std::unique_ptr<FrameTerm> Clone() const override {
    return std::make_unique<Term>(static_cast<const Term&>(*this));
  }
};

/// The terms of one frame in the order in which they are summed. Copies copy the terms.
class TermList {
 public:
  TermList() = default;
  TermList(const TermList& other) { *this = other; }
  TermList& operator=(const TermList& other) {
    if (this == &other) return *this;
    terms_.clear();
    for (const auto& term : other.terms_) terms_.push_back(term->Clone());
    return *this;
  }
  TermList(TermList&&) = default;
  TermList& operator=(TermList&&) = default;

  void Add(std::unique_ptr<FrameTerm> term) { terms_.push_back(std::move(term)); }
  /// The first term of this class; null if there is none.
  template <typename Term>
  [[nodiscard]] Term* Find() {
    for (const auto& term : terms_) {
      if (auto* found = dynamic_cast<Term*>(term.get()); found != nullptr) return found;
    }
    return nullptr;
  }
  template <typename Term>
  [[nodiscard]] const Term* Find() const {
    return const_cast<TermList*>(this)->Find<Term>();
  }
  /// The first term of this class; a new one is added at the end if there is none.
  template <typename Term>
  Term& Get() {
    if (Term* found = Find<Term>(); found != nullptr) return *found;
    Add(std::make_unique<Term>());
    return static_cast<Term&>(*terms_.back());
  }
  /// The first term of this class, or an empty one if there is none.
  template <typename Term>
  [[nodiscard]] const Term& Get() const {
    static const Term kNothing;
    const Term* found = Find<Term>();
    return found != nullptr ? *found : kNothing;
  }
  void Clear() { terms_.clear(); }

  [[nodiscard]] size_t size() const { return terms_.size(); }
  [[nodiscard]] auto begin() const { return terms_.begin(); }
  [[nodiscard]] auto end() const { return terms_.end(); }

 private:
  std::vector<std::unique_ptr<FrameTerm>> terms_;
};

}  // namespace bodyloom
