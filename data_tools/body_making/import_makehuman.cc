// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body_making/import_makehuman.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>

#include "bodyloom/data_tools/body_making/makehuman_files.h"
#include "bodyloom/data_tools/body_making/makehuman_population.h"
#include "bodyloom/data_tools/body_making/makehuman_skinning.h"
#include "bodyloom/data_tools/body_making/makehuman_tpose.h"
#include "bodyloom/data_tools/body_making/subdivision.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// Mean and principal components of the people, weighted by the area around each vertex, in units per standard
/// deviation.
void FillShape(const std::vector<MatrixX3d>& people, int num_betas, BodyModelData* body,
               ImportMakeHumanSummary* summary) {
  const auto count = static_cast<Eigen::Index>(people.size());
  const Eigen::Index size = people[0].size();
  body->v_template.setZero(people[0].rows(), 3);
  for (const MatrixX3d& person : people) body->v_template += person / static_cast<double>(count);

  Eigen::VectorXd area = Eigen::VectorXd::Zero(size);
  for (Eigen::Index f = 0; f < body->faces.rows(); ++f) {
    const Eigen::Vector3d a = body->v_template.row(body->faces(f, 0)), b = body->v_template.row(body->faces(f, 1)),
                          c = body->v_template.row(body->faces(f, 2));
    const double share = (b - a).cross(c - a).norm() / 6;
    for (int k = 0; k < 3; ++k) area.segment<3>(3 * body->faces(f, k)).array() += share;
  }
  RowMatrixXd offsets(count, size);
  for (Eigen::Index i = 0; i < count; ++i) {
    offsets.row(i) = Eigen::Map<const Eigen::RowVectorXd>(people[i].data(), size) -
                     Eigen::Map<const Eigen::RowVectorXd>(body->v_template.data(), size);
  }
  const Eigen::MatrixXd gram = offsets * area.asDiagonal() * offsets.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
  const double total = solver.eigenvalues().sum();
  double explained = 0;
  body->shapedirs.resize(size, num_betas);
  for (int b = 0; b < num_betas; ++b) {
    const Eigen::Index column = count - 1 - b;  // eigenvalues come in increasing order
    Eigen::VectorXd component =
        offsets.transpose() * solver.eigenvectors().col(column) / std::sqrt(static_cast<double>(count - 1));
    const auto shape = Eigen::Map<const MatrixX3d>(component.data(), size / 3, 3);
    Eigen::Index top = 0, bottom = 0;
    body->v_template.col(1).maxCoeff(&top);
    body->v_template.col(1).minCoeff(&bottom);
    if (shape(top, 1) < shape(bottom, 1)) component = -component;
    body->shapedirs.col(b) = component.cast<float>();
    explained += solver.eigenvalues()[column];
    summary->cumulative_variance.push_back(explained / total);
  }
}

/// Triangles and texture coordinates of the body's quads; UV vertices that only helpers use are left out.
void FillFaces(const MakeHumanFiles& files, BodyModelData* body) {
  body->faces = TrianglesOfQuads(files.quads);
  MatrixX3i corners = TrianglesOfQuads(files.quads_uv);
  std::vector<int> index_of(files.uv.rows(), -1);
  std::vector<int> used;
  for (Eigen::Index i = 0; i < corners.size(); ++i) {
    int& index = index_of[corners.data()[i]];
    if (index < 0) {
      index = static_cast<int>(used.size());
      used.push_back(corners.data()[i]);
    }
    corners.data()[i] = index;
  }
  body->ft = corners;
  body->vt = files.uv(used, Eigen::all).cast<float>();
}

class LandmarkFinder {
 public:
  explicit LandmarkFinder(const BodyModelData& body) : body_(body) {}

  /// The vertex farthest along `direction` among those that mostly move with one of `joints`.
  [[nodiscard]] int Farthest(const std::vector<int>& joints, const Eigen::RowVector3d& direction) const {
    int best = -1;
    double most = -std::numeric_limits<double>::infinity();
    for (int v = 0; v < body_.weights.rows(); ++v) {
      double share = 0;
      for (int joint : joints) share += body_.weights.coeff(v, joint);
      const double reach = body_.v_template.row(v).dot(direction);
      if (share > 0.5 && reach > most) {
        most = reach;
        best = v;
      }
    }
    return best;
  }

  [[nodiscard]] int Nearest(const Eigen::RowVector3d& point) const {
    Eigen::Index best = 0;
    (body_.v_template.rowwise() - point).rowwise().squaredNorm().minCoeff(&best);
    return static_cast<int>(best);
  }

  [[nodiscard]] Landmark Joint(const std::string& name, int joint, double share = 1) const {
    Landmark landmark{name, {}, {}};
    for (SparseRows::InnerIterator it(body_.J_regressor, joint); it; ++it) {
      landmark.vertices.push_back(static_cast<int>(it.col()));
      landmark.weights.push_back(share * it.value());
    }
    return landmark;
  }

 private:
  const BodyModelData& body_;
};

/// joints: 24×3; left_eye: mean centre of the left eye; both in metres, T-pose.
void FillLandmarks(const MatrixX3d& joints, const Eigen::RowVector3d& left_eye, BodyModelData* body) {
  const LandmarkFinder find(*body);
  const auto add = [&](const std::string& name, int vertex) { body->landmarks.push_back({name, {vertex}, {1.0}}); };
  const Eigen::RowVector3d front(0, 0, 1), mirror(-1, 1, 1);
  const int head = 15;
  add("nose", find.Farthest({head}, front));
  const std::string sides[2] = {"left_", "right_"};
  const double out[2] = {1, -1};
  const auto both = [&](const auto& landmark_of) {
    for (int side = 0; side < 2; ++side) landmark_of(side);
  };
  both([&](int side) {
    const Eigen::RowVector3d eye = side == 0 ? left_eye : Eigen::RowVector3d(left_eye.cwiseProduct(mirror));
    add(sides[side] + "eye", find.Nearest(eye + 0.03 * front));
  });
  both([&](int side) { add(sides[side] + "ear", find.Farthest({head}, {out[side], 0, 0})); });
  for (const auto& [name, joint] : {std::pair{"shoulder", 16}, {"elbow", 18}, {"wrist", 20}}) {
    both([&, name = name, joint = joint](int side) {
      body->landmarks.push_back(find.Joint(sides[side] + name, joint + side));
    });
  }
  both([&](int side) {  // COCO's hips lie further out than the joint
    Landmark hip = find.Joint(sides[side] + "hip", 1 + side, 0.75);
    hip.vertices.push_back(find.Nearest(joints.row(1 + side) + Eigen::RowVector3d(0.12 * out[side], 0, 0)));
    hip.weights.push_back(0.25);
    body->landmarks.push_back(hip);
  });
  for (const auto& [name, joint] : {std::pair{"knee", 4}, {"ankle", 7}}) {
    both([&, name = name, joint = joint](int side) {
      body->landmarks.push_back(find.Joint(sides[side] + name, joint + side));
    });
  }
  both([&](int side) { add(sides[side] + "big_toe", find.Farthest({10 + side}, {-0.3 * out[side], 0, 1})); });
  both([&](int side) { add(sides[side] + "small_toe", find.Farthest({10 + side}, {1.0 * out[side], 0, 0.7})); });
  both([&](int side) { add(sides[side] + "heel", find.Farthest({7 + side}, {0, -0.3, -1})); });
}

}  // namespace

bool ImportMakeHumanOptions::IsValid(std::string* why) const {
  if (num_people < 20 || num_people > 5000) {
    *why = Concatenate("num_people is ", num_people, ", expected 20..5000");
  } else if (num_betas < 1 || num_betas > std::min(num_people - 1, 100)) {
    *why = Concatenate("num_betas is ", num_betas, ", expected 1..", std::min(num_people - 1, 100));
  } else if (!(metres_per_unit > 1e-6 && metres_per_unit < 1e3)) {
    *why = Concatenate("metres_per_unit is ", metres_per_unit, ", expected a length");
  } else {
    return true;
  }
  return false;
}

BodyModelData ImportMakeHuman(const std::string& folder, const ImportMakeHumanOptions& options,
                              ImportMakeHumanSummary* summary) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "import of MakeHuman: ", why);
  ImportMakeHumanSummary unused;
  if (summary == nullptr) summary = &unused;
  *summary = {};
  const MakeHumanFiles files = ReadMakeHuman(folder);
  summary->targets = static_cast<int>(files.targets.size());
  const auto eye_cube = files.joint_cubes.find("joint-l-eye");
  if (eye_cube == files.joint_cubes.end()) {
    throw std::runtime_error(folder + "/base.obj: no joint cube 'joint-l-eye', which the landmarks need");
  }

  std::mt19937 random(options.seed);
  std::vector<MatrixX3d> people, joints;
  MatrixX3d mean_joints = MatrixX3d::Zero(24, 3);
  Eigen::RowVector3d left_eye = Eigen::RowVector3d::Zero();
  const double share = 1.0 / options.num_people;
  for (int i = 0; i < options.num_people; ++i) {
    const MatrixX3d blended = BlendMakeHuman(files, RandomAdult(&random));
    MakeHumanTPose pose;
    try {
      pose = PoseMakeHuman(files, blended, options.metres_per_unit);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(folder + ": " + error.what());
    }
    if (!pose.vertices.allFinite() || !pose.joints.allFinite()) {
      throw std::runtime_error(folder + ": the rig and the mesh give no finite T-pose (bones of no length?)");
    }
    summary->mean_height_m += share * (pose.vertices.col(1).maxCoeff() - pose.vertices.col(1).minCoeff());
    // The head keeps its rest orientation, so the eye moves with the head joint.
    const Eigen::RowVector3d head = pose.joints.row(15);
    Eigen::RowVector3d eye = blended(eye_cube->second, Eigen::all).colwise().mean();
    const auto head_cube = files.joint_cubes.find("joint-head");
    eye -= blended(head_cube->second, Eigen::all).colwise().mean();
    left_eye += share * (head + options.metres_per_unit * eye);
    mean_joints += share * pose.joints;
    people.push_back(std::move(pose.vertices));
    joints.push_back(std::move(pose.joints));
  }

  BodyModelData body;
  body.name = "makehuman";
  body.joint_names = SmplJointNames();
  body.parents = SmplParents();
  FillFaces(files, &body);
  FillShape(people, options.num_betas, &body, summary);
  body.weights = SmplWeightsFromMakeHuman(files, body.v_template, mean_joints);
  body.J_regressor = FitJointRegressor(people, joints, body.weights, &summary->joint_errors_mm);
  for (double& error : summary->joint_errors_mm) error *= 1000;
  FillLandmarks(mean_joints, left_eye, &body);
  return body;
}

}  // namespace bodyloom
