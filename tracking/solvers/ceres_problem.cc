// SPDX-License-Identifier: Apache-2.0
#include "tracking/solvers/ceres_problem.h"

#include <ceres/loss_function.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/solvers/residuals/acceleration_cost.h"
#include "tracking/solvers/residuals/ceres_functions.h"
#include "tracking/solvers/residuals/coupling_cost.h"
#include "tracking/solvers/residuals/frame_batch.h"

namespace bodyloom {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Addresses of parameters must not change.
struct CeresProblem::Memory {
  const SequenceProblem& source;
  int begin, end;   ///< frames that are parameters
  int first, last;  ///< with those that are held constant beside them
  bool compress;
  size_t num_active;
  RotationManifold manifold;
  std::vector<double> rotations, translations;  ///< (last − first) × A × 3, × 3
  VectorXd betas;
  double log_focal = 0;
  struct View {
    Vector3d rotation, translation;  ///< axis-angle
    double log_focal = 0;
    std::array<double, 2> clock{};
  };
  std::vector<View> views;
  FrameBatch batch;
  std::map<std::tuple<int, double, double, ceres::LossFunction*>, std::unique_ptr<ceres::LossFunctionWrapper>> losses;
  std::vector<std::string> terms;
  std::vector<double> weights;  ///< of each term
  std::vector<Block> blocks;
  std::unique_ptr<ceres::Problem> problem;  ///< refers to all of the above, so it goes first

  Memory(const SequenceProblem& given, const CeresProblemOptions& options);
  double* Rotation(int t, size_t a) { return &rotations[3 * ((t - first) * num_active + a)]; }
  double* Translation(int t) { return &translations[3 * static_cast<size_t>(t - first)]; }
  /// The blocks of the views' unknowns, in the layout's order.
  std::vector<double*> ViewBlocks();
  int Term(const std::string& name);
  ceres::LossFunction* Loss(int term, double kernel, double weight, ceres::LossFunction* given);
  void Wrap(int term, double kernel, double weight, ceres::LossFunction* given, ceres::LossFunctionWrapper* wrapper);
};

CeresProblem::Memory::Memory(const SequenceProblem& given, const CeresProblemOptions& options)
    : source(given),
      begin(options.begin),
      end(options.end < 0 ? static_cast<int>(given.states.size()) : options.end),
      compress(options.compress_frames),
      num_active(given.layout.active_joints.size()),
      betas(given.betas),
      log_focal(given.log_focal),
      batch(options.num_threads, options.compress_frames) {
  const int T = static_cast<int>(given.states.size());
  BODYLOOM_CHECK(begin >= 0 && begin < end && end <= T, "ceres problem: frames ", begin, " to ", end, " of ", T);
  first = std::max(0, begin - 2);
  last = std::min(T, end + 2);
  for (int t = first; t < last; ++t) {
    const FrameState& state = given.states[t];
    for (int j : given.layout.active_joints) {
      const Vector3d w = AxisAngleFromRotation(state.rotations[j]);
      rotations.insert(rotations.end(), w.data(), w.data() + 3);
    }
    translations.insert(translations.end(), state.translation.data(), state.translation.data() + 3);
  }
  for (const ViewState& view : given.views) {
    const CameraPose& pose = view.camera_from_scene;
    views.push_back({AxisAngleFromRotation(pose.camera_from_world_rotation),
                     pose.camera_from_world_translation,
                     view.log_focal,
                     {view.offset_s, view.rate}});
  }
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  problem_options.evaluation_callback = &batch;
  problem_options.enable_fast_removal = options.enable_fast_removal;
  problem_options.disable_all_safety_checks = true;
  problem = std::make_unique<ceres::Problem>(problem_options);
}

std::vector<double*> CeresProblem::Memory::ViewBlocks() {
  std::vector<double*> blocks;
  for (size_t v = 0; v < views.size(); ++v) {
    const ViewLayout& layout = source.layout.views[v];
    if (layout.pose_column >= 0) {
      blocks.push_back(views[v].rotation.data());
      blocks.push_back(views[v].translation.data());
    }
    if (layout.focal_column >= 0) blocks.push_back(&views[v].log_focal);
    if (layout.clock_column >= 0) blocks.push_back(views[v].clock.data());
  }
  return blocks;
}

int CeresProblem::Memory::Term(const std::string& name) {
  const auto at = std::find(terms.begin(), terms.end(), name);
  if (at != terms.end()) return static_cast<int>(at - terms.begin());
  terms.push_back(name);
  weights.push_back(1);
  return static_cast<int>(terms.size()) - 1;
}

void CeresProblem::Memory::Wrap(int term, double kernel, double weight, ceres::LossFunction* given,
                                ceres::LossFunctionWrapper* wrapper) {
  const double scale = weight * weights[term];
  ceres::LossFunction* loss = given;
  if (loss == nullptr && kernel > 0) loss = new GemanMcClureLoss(kernel);
  const ceres::Ownership ownership = given != nullptr ? ceres::DO_NOT_TAKE_OWNERSHIP : ceres::TAKE_OWNERSHIP;
  if (scale == 1 && loss != nullptr) {
    wrapper->Reset(loss, ownership);
  } else {
    wrapper->Reset(new ceres::ScaledLoss(loss, scale, ownership), ceres::TAKE_OWNERSHIP);
  }
}

ceres::LossFunction* CeresProblem::Memory::Loss(int term, double kernel, double weight, ceres::LossFunction* given) {
  auto& wrapper = losses[{term, kernel, weight, given}];
  if (wrapper == nullptr) {
    wrapper = std::make_unique<ceres::LossFunctionWrapper>(nullptr, ceres::TAKE_OWNERSHIP);
    Wrap(term, kernel, weight, given, wrapper.get());
  }
  return wrapper.get();
}

/// Adds the blocks to the problem, in an order that depends only on the clip.
class CeresProblem::Builder {
 public:
  explicit Builder(Memory* memory) : m_(*memory), source_(memory->source), layout_(memory->source.layout) {}

  void Build() {
    AddParameters();
    AddFrames();
    AddSmoothness();
    AddVelocities();
    AddSharedPriors();
    AddCouplings();
  }

 private:
  void AddParameters() {
    for (int t = m_.first; t < m_.last; ++t) {
      const bool constant = t < m_.begin || t >= m_.end;
      for (size_t a = 0; a < m_.num_active; ++a) {
        m_.problem->AddParameterBlock(m_.Rotation(t, a), 3, &m_.manifold);
        if (constant) m_.problem->SetParameterBlockConstant(m_.Rotation(t, a));
      }
      m_.problem->AddParameterBlock(m_.Translation(t), 3);
      if (constant) m_.problem->SetParameterBlockConstant(m_.Translation(t));
    }
    if (layout_.num_betas > 0) m_.problem->AddParameterBlock(m_.betas.data(), layout_.num_betas);
    if (layout_.focal_column >= 0) m_.problem->AddParameterBlock(&m_.log_focal, 1);
    for (size_t v = 0; v < m_.views.size(); ++v) {
      const ViewLayout& view = layout_.views[v];
      if (view.pose_column >= 0) {
        m_.problem->AddParameterBlock(m_.views[v].rotation.data(), 3, &m_.manifold);
        m_.problem->AddParameterBlock(m_.views[v].translation.data(), 3);
      }
      if (view.focal_column >= 0) m_.problem->AddParameterBlock(&m_.views[v].log_focal, 1);
      if (view.clock_column >= 0) m_.problem->AddParameterBlock(m_.views[v].clock.data(), 2);
    }
  }

  void Add(int term, int frame, ceres::CostFunction* cost, ceres::LossFunction* loss,
           const std::vector<double*>& parameters) {
    m_.blocks.push_back({m_.problem->AddResidualBlock(cost, loss, parameters), term, frame});
  }

  void AddFrames() {
    std::vector<double*> all, some;
    const std::vector<double*> of_views = m_.ViewBlocks();
    for (int t = m_.begin; t < m_.end; ++t) {
      all.clear();
      for (size_t a = 0; a < m_.num_active; ++a) all.push_back(m_.Rotation(t, a));
      all.push_back(m_.Translation(t));
      if (layout_.num_betas > 0) all.push_back(m_.betas.data());
      if (layout_.focal_column >= 0) all.push_back(&m_.log_focal);
      all.insert(all.end(), of_views.begin(), of_views.end());
      std::vector<FrameBatch::Entry> entries =
          m_.batch.Add(layout_, source_.frames[t], source_.states[t], source_, all);
      std::vector<int> term_of_list;
      if (!m_.compress) {
        source_.frames[t].ForEachTerm([&](const FrameTerm* term, int view) {
          term_of_list.push_back(term->is_empty() ? -1 : m_.Term(NameOfTerm(*term, view)));
        });
      }
      for (FrameBatch::Entry& entry : entries) {
        some.clear();
        for (const int block : entry.group.blocks) some.push_back(all[block]);
        const int term = entry.term < 0 ? m_.Term("terms of the frame") : term_of_list[entry.term];
        Add(term, t, entry.cost.release(), m_.Loss(term, entry.group.kernel, entry.group.weight, entry.group.loss),
            some);
      }
    }
  }

  void AddSmoothness() {
    if (m_.last - m_.first < 3) return;
    const int term = m_.Term("smoothness");
    ceres::LossFunction* loss = m_.Loss(term, 0, 1, nullptr);
    const std::vector<int> shot = ShotOfFrames(source_.cut_before);
    std::vector<double> joint_sigma;
    std::array<double, 3> root_sigma{};
    int sigma_of_shot = -1;
    for (int t = m_.first + 2; t < m_.last; ++t) {
      // Not of constant frames alone.
      if (t < m_.begin || t - 2 >= m_.end || source_.cut_before[t] || source_.cut_before[t - 1]) continue;
      if (shot[t] != sigma_of_shot) {
        sigma_of_shot = shot[t];
        joint_sigma = JointAccelerationSigma(source_, shot[t]);
        root_sigma = RootAccelerationSigma(source_, shot[t]);
      }
      const double dt0 = source_.timestamps[t - 1] - source_.timestamps[t - 2];
      const double dt1 = source_.timestamps[t] - source_.timestamps[t - 1];
      for (size_t a = 0; a < m_.num_active; ++a) {
        Add(term, t - 2, new RotationAccelerationCost(dt0, dt1, joint_sigma[layout_.active_joints[a]]), loss,
            {m_.Rotation(t - 2, a), m_.Rotation(t - 1, a), m_.Rotation(t, a)});
      }
      Add(term, t - 2, new VectorAccelerationCost(dt0, dt1, root_sigma.data()), loss,
          {m_.Translation(t - 2), m_.Translation(t - 1), m_.Translation(t)});
    }
  }

  void AddVelocities() {
    if (source_.velocity_weight <= 0) return;
    const int term = m_.Term("velocity");
    ceres::LossFunction* loss = m_.Loss(term, 0, 1, nullptr);
    const std::vector<double> joint_sigma = JointVelocitySigma(source_);
    const std::array<double, 3> root_sigma = RootVelocitySigma(source_);
    for (int t = m_.first + 1; t < m_.last; ++t) {
      if (t < m_.begin || t - 1 >= m_.end || source_.cut_before[t]) continue;
      const double dt = source_.timestamps[t] - source_.timestamps[t - 1];
      for (size_t a = 0; a < m_.num_active; ++a) {
        Add(term, t - 1, new RotationVelocityCost(dt, joint_sigma[layout_.active_joints[a]]), loss,
            {m_.Rotation(t - 1, a), m_.Rotation(t, a)});
      }
      Add(term, t - 1, new VectorVelocityCost(dt, root_sigma.data()), loss, {m_.Translation(t - 1), m_.Translation(t)});
    }
  }

  void AddSharedPriors() {
    if (layout_.num_betas > 0) {
      RowMatrixXd A;
      VectorXd b;
      ShapePriorRows(source_, &A, &b);
      const int B = layout_.num_betas, prior = m_.Term("shape prior"), stature = m_.Term("stature");
      Add(prior, -1, new LinearCost(A.topRows(B), b.head(B)), m_.Loss(prior, 0, 1, nullptr), {m_.betas.data()});
      Add(stature, -1, new LinearCost(A.bottomRows(1), b.tail(1)), m_.Loss(stature, 0, 1, nullptr), {m_.betas.data()});
    }
    // One residual block a parameter block: a clock has the priors of its two columns.
    const std::vector<double*> of_views = m_.ViewBlocks();
    const auto parameter_of = [&](int block) {
      return block == layout_.FocalBlock()
                 ? &m_.log_focal
                 : of_views[block - (layout_.num_blocks() - static_cast<int>(of_views.size()))];
    };
    const std::vector<SharedPrior> priors = SharedPriors(source_, source_);
    for (size_t i = 0; i < priors.size();) {
      if (priors[i].minus_column >= 0) {
        const SharedPrior& prior = priors[i++];
        const int term = m_.Term(prior.term);
        const RowMatrixXd A{{1 / prior.sigma, -1 / prior.sigma}};
        Add(term, -1, new LinearCost(A, VectorXd::Constant(1, -prior.mean / prior.sigma), {1, 1}),
            m_.Loss(term, 0, 1, nullptr),
            {parameter_of(BlockOf(prior.column)), parameter_of(BlockOf(prior.minus_column))});
        continue;
      }
      const int block = BlockOf(priors[i].column), columns = layout_.NumColumns(block);
      RowMatrixXd A = RowMatrixXd::Zero(columns, columns);
      VectorXd b(columns);
      const int term = m_.Term(priors[i].term);
      for (int k = 0; k < columns; ++k, ++i) {
        A(k, k) = 1 / priors[i].sigma;
        b[k] = -priors[i].mean / priors[i].sigma;
      }
      Add(term, -1, new LinearCost(A, b), m_.Loss(term, 0, 1, nullptr), {parameter_of(block)});
    }
  }

  /// The block of a shared column.
  [[nodiscard]] int BlockOf(int column) const {
    int block = layout_.num_blocks() - 1;
    while (layout_.FirstColumn(block) > column) --block;
    return block;
  }

  void AddCouplings() {
    for (const FrameCoupling& coupling : source_.couplings) {
      const auto inside = [&](int t) { return t >= m_.begin && t < m_.end; };
      if (!std::any_of(coupling.frames.begin(), coupling.frames.end(), inside)) continue;
      BODYLOOM_CHECK(coupling.frames.front() >= m_.first && coupling.frames.back() < m_.last,
                     "ceres problem: the term '", coupling.cost.inputs->term, "' reads frames beyond ", m_.first,
                     " to ", m_.last);
      auto cost = std::make_unique<CouplingCost>(coupling, layout_, source_.states);
      std::vector<double*> parameters;
      for (const CouplingCost::Parameter& of : cost->parameters()) {
        parameters.push_back(of.frame < 0 ? of.block == layout_.BetaBlock() ? m_.betas.data() : &m_.log_focal
                             : of.block == layout_.TranslationBlock()
                                 ? m_.Translation(coupling.frames[of.frame])
                                 : m_.Rotation(coupling.frames[of.frame], of.block));
      }
      const int term = m_.Term(coupling.cost.inputs->term);
      Add(term, coupling.frames.front(), cost.release(), m_.Loss(term, 0, 1, coupling.cost.loss.get()), parameters);
    }
  }

  Memory& m_;
  const SequenceProblem& source_;
  const FrameLayout& layout_;
};

CeresProblem::CeresProblem(const SequenceProblem& problem, const CeresProblemOptions& options)
    : memory_(std::make_unique<Memory>(problem, options)) {
  Builder(memory_.get()).Build();
}

CeresProblem::~CeresProblem() = default;

ceres::Problem& CeresProblem::problem() { return *memory_->problem; }

double* CeresProblem::rotation(int t, int joint) {
  const std::vector<int>& active = memory_->source.layout.active_joints;
  const auto at = std::find(active.begin(), active.end(), joint);
  if (t < memory_->begin || t >= memory_->end || at == active.end()) return nullptr;
  return memory_->Rotation(t, static_cast<size_t>(at - active.begin()));
}

double* CeresProblem::translation(int t) {
  return t < memory_->begin || t >= memory_->end ? nullptr : memory_->Translation(t);
}

double* CeresProblem::betas() { return memory_->betas.size() > 0 ? memory_->betas.data() : nullptr; }

double* CeresProblem::log_focal() { return memory_->source.layout.focal_column >= 0 ? &memory_->log_focal : nullptr; }

std::vector<double*> CeresProblem::view_blocks() { return memory_->ViewBlocks(); }

std::string CeresProblem::NameOf(const double* block) const {
  const Memory& m = *memory_;
  if (block == &m.log_focal) return "logarithm of the focal length";
  for (size_t v = 0; v < m.views.size(); ++v) {
    const std::string which = Concatenate(" of view ", v + 2);
    if (block == m.views[v].rotation.data()) return "rotation" + which;
    if (block == m.views[v].translation.data()) return "translation" + which;
    if (block == &m.views[v].log_focal) return "logarithm of the focal length" + which;
    if (block == m.views[v].clock.data()) return "clock" + which;
  }
  if (block == m.betas.data()) return "shape";
  const auto within = [&](const std::vector<double>& values) {
    return block >= values.data() && block < values.data() + values.size();
  };
  if (within(m.translations)) {
    return Concatenate("translation, frame ", m.first + (block - m.translations.data()) / 3);
  }
  if (!within(m.rotations)) return "";
  const auto index = static_cast<size_t>(block - m.rotations.data()) / 3;
  const BodyModel& body = *m.source.layout.model;
  const int joint = m.source.layout.active_joints[index % m.num_active];
  return Concatenate("rotation of ", body.data().joint_names[joint], ", frame ",
                     m.first + static_cast<int>(index / m.num_active));
}

const std::vector<std::string>& CeresProblem::terms() const { return memory_->terms; }

const std::vector<CeresProblem::Block>& CeresProblem::residual_blocks() const { return memory_->blocks; }

std::vector<double> CeresProblem::CostByTerm() {
  std::vector<double> costs(memory_->terms.size(), 0.0);
  memory_->batch.PrepareForEvaluation(false, true);
  for (const Block& block : memory_->blocks) {
    double cost = 0;
    // The point is prepared, so blocks use the cached evaluation.
    memory_->problem->EvaluateResidualBlockAssumingParametersUnchanged(block.id, true, &cost, nullptr, nullptr);
    costs[block.term] += cost;
  }
  return costs;
}

void CeresProblem::SetWeight(const std::string& term, double weight) {
  const auto at = std::find(memory_->terms.begin(), memory_->terms.end(), term);
  BODYLOOM_CHECK(at != memory_->terms.end(), "ceres problem: no term '", term, "'");
  BODYLOOM_CHECK(std::isfinite(weight) && weight >= 0, "ceres problem: weight ", weight, " of '", term,
                 "', expected a number that is not negative");
  const int index = static_cast<int>(at - memory_->terms.begin());
  memory_->weights[index] = weight;
  for (const auto& [key, wrapper] : memory_->losses) {
    const auto& [of_term, kernel, own_weight, loss] = key;
    if (of_term == index) memory_->Wrap(index, kernel, own_weight, loss, wrapper.get());
  }
}

void CeresProblem::CopyTo(SequenceProblem* problem) const {
  Memory& m = *memory_;
  for (int t = m.begin; t < m.end; ++t) {
    FrameState& state = problem->states[t];
    for (size_t a = 0; a < m.num_active; ++a) {
      state.rotations[problem->layout.active_joints[a]] =
          RotationFromAxisAngle(Eigen::Map<const Vector3d>(m.Rotation(t, a)));
    }
    state.translation = Eigen::Map<const Vector3d>(m.Translation(t));
  }
  problem->betas = m.betas;
  problem->log_focal = m.log_focal;
  for (size_t v = 0; v < m.views.size(); ++v) {
    ViewState& view = problem->views[v];
    view.camera_from_scene = {RotationFromAxisAngle(m.views[v].rotation), m.views[v].translation};
    view.log_focal = m.views[v].log_focal;
    view.offset_s = m.views[v].clock[0];
    view.rate = m.views[v].clock[1];
  }
}

}  // namespace bodyloom
