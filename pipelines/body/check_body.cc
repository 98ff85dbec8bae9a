// SPDX-License-Identifier: Apache-2.0
#include "pipelines/body/check_body.h"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

#include "data_tools/body/body_io.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/track_io.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/scene/track.h"
#include "pipelines/files.h"
#include "pipelines/render/render_track.h"
#include "pipelines/report_text.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

constexpr int kExamples = 5;

/// "vertices 3, 8, 12, …".
std::string ExamplesText(const std::string& what, const std::vector<int>& numbers) {
  std::string text = what;
  for (size_t i = 0; i < numbers.size() && i < kExamples; ++i)
    text += (i > 0 ? ", " : " ") + std::to_string(numbers[i]);
  return text + (numbers.size() > kExamples ? ", …" : "");
}

std::string PairsText(const std::string& what, const std::vector<std::array<int, 2>>& pairs, const char* between) {
  std::string text = what;
  for (size_t i = 0; i < pairs.size() && i < kExamples; ++i) {
    text += Concatenate(i > 0 ? ", " : " ", pairs[i][0], between, pairs[i][1]);
  }
  return text + (pairs.size() > kExamples ? ", …" : "");
}

std::string ComponentsText(const std::vector<MeshComponent>& components) {
  std::vector<int> faces;
  faces.reserve(components.size());
  for (const MeshComponent& component : components) faces.push_back(component.num_faces);
  return ExamplesText("of", faces) + " faces";
}

std::vector<BodyFinding> FindingsOf(const CheckMeshResult& mesh) {
  std::vector<BodyFinding> findings;
  const auto add = [&](const std::string& what, size_t count, const std::string& details) {
    if (count > 0) findings.push_back({what, static_cast<int>(count), details});
  };
  add("faces that name a vertex twice", mesh.repeated_corner_faces.size(),
      ExamplesText("faces", mesh.repeated_corner_faces));
  add("faces with the vertices of another", mesh.duplicate_faces.size(), ExamplesText("faces", mesh.duplicate_faces));
  add("faces without area", mesh.flat_faces.size(), ExamplesText("faces", mesh.flat_faces));
  add("vertices at the place of another", mesh.duplicate_vertices.size(),
      PairsText("vertices", mesh.duplicate_vertices, " at "));
  add("vertices in no face", mesh.unreferenced_vertices.size(), ExamplesText("vertices", mesh.unreferenced_vertices));
  add("edges of more than two faces", mesh.non_manifold_edges.size(),
      PairsText("vertices", mesh.non_manifold_edges, "-"));
  add("vertices that join separate fans", mesh.non_manifold_vertices.size(),
      ExamplesText("vertices", mesh.non_manifold_vertices));
  std::vector<int> lengths;
  for (const std::vector<int>& loop : mesh.boundary_loops) lengths.push_back(static_cast<int>(loop.size()));
  add("holes (boundary loops)", mesh.boundary_loops.size(),
      ExamplesText("of", lengths) + " edges" +
          (lengths.empty() ? "" : Concatenate(", the first at vertex ", mesh.boundary_loops[0][0])));
  add("faces that face the wrong way", mesh.turned_faces.size(),
      mesh.inconsistent_edges > 0 ? Concatenate(ExamplesText("faces", mesh.turned_faces), "; ", mesh.inconsistent_edges,
                                                " edges between both ways")
                                  : "the surface is inside out");
  const auto one_sided = std::count_if(mesh.components.begin(), mesh.components.end(),
                                       [](const MeshComponent& c) { return !c.is_orientable; });
  add("components that no turning of faces orients", static_cast<size_t>(one_sided), "as a Moebius strip");
  if (mesh.components.size() != 1) {
    findings.push_back({"separate components", static_cast<int>(mesh.components.size()),
                        mesh.components.empty() ? "no face at all" : ComponentsText(mesh.components)});
  }
  return findings;
}

std::string DescriptionOf(const BodyModelData& body, const CheckMeshResult& mesh) {
  double volume_m3 = 0;
  for (const MeshComponent& component : mesh.components) volume_m3 += component.volume_m3;
  return Concatenate("mesh of '", body.name, "': ", body.v_template.rows(), " vertices, ", body.faces.rows(),
                     " faces, ", Fixed(1000 * volume_m3, 1), " litres");
}

std::string JointOfFace(const BodyModel& body, int face) {
  const int v = body.data().faces(face, 0);
  const auto begin = body.influence_weight().begin();
  const auto largest =
      std::max_element(begin + body.influence_begin()[v], begin + body.influence_begin()[v + 1]) - begin;
  return body.data().joint_names[body.influence_joint()[largest]];
}

/// The two joints between whose surfaces the most pairs lie: "l_elbow and spine1".
std::string MostCrossed(const BodyModel& body, const std::vector<std::array<int, 2>>& pairs) {
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const auto& [a, b] : pairs) ++counts[std::minmax(JointOfFace(body, a), JointOfFace(body, b))];
  const auto maximum =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return maximum->first.first == maximum->first.second
             ? "within " + maximum->first.first
             : "between " + maximum->first.first + " and " + maximum->first.second;
}

/// The faces that cross each other, without those that CheckMesh calls superfluous.
class Crossings {
 public:
  Crossings(const BodyModelData& body, const FindCrossingFaces& find) : find_(find) {
    const std::vector<int> superfluous = SuperfluousFaces(CheckMesh(body.v_template, body.faces));
    for (int f = 0; f < body.faces.rows(); ++f) {
      if (!std::binary_search(superfluous.begin(), superfluous.end(), f)) number_.push_back(f);
    }
    faces_.resize(static_cast<Eigen::Index>(number_.size()), 3);
    for (size_t i = 0; i < number_.size(); ++i) faces_.row(static_cast<Eigen::Index>(i)) = body.faces.row(number_[i]);
  }
  [[nodiscard]] std::vector<std::array<int, 2>> In(const MatrixX3d& vertices) const {
    std::vector<std::array<int, 2>> pairs = find_(vertices, faces_);
    for (auto& [a, b] : pairs) a = number_[a], b = number_[b];
    return pairs;
  }

 private:
  const FindCrossingFaces& find_;
  MatrixX3i faces_;
  std::vector<int> number_;  // of the body's faces
};

/// Looks for crossing faces at rest and in the track's poses.
std::vector<BodyFinding> CrossingsOf(const BodyModel& body, const CheckBodyRequest& request, CheckBodyReport* report,
                                     const PipelineCallbacks& callbacks) {
  std::vector<BodyFinding> findings;
  const Crossings crossings(body.data(), request.surface_tools.crossing);
  const std::vector<std::array<int, 2>> at_rest = crossings.In(body.data().v_template);
  if (!at_rest.empty()) {
    findings.push_back({"pairs of faces that cross at rest", static_cast<int>(at_rest.size()),
                        PairsText("faces", at_rest, "x") + "; most " + MostCrossed(body, at_rest)});
  }
  if (request.track.empty()) return findings;
  const Track track = ReadTrack(request.track, MovingCamera::kTake);
  RequireTrackFitsBody(track, body, request.track);
  const auto [first, end] = FrameRange(request.frames, track.num_frames(), request.track);
  int crossed = 0, worst_frame = -1;
  std::vector<std::array<int, 2>> worst;
  for (int t = first; t < end; ++t) {
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() > 0) {
      const std::vector<std::array<int, 2>> pairs = crossings.In(vertices);
      ++report->poses_checked;
      crossed += pairs.empty() ? 0 : 1;
      if (pairs.size() > worst.size()) worst = pairs, worst_frame = t;
    }
    callbacks.Update("poses", static_cast<double>(t + 1 - first) / (end - first));
  }
  if (crossed > 0) {
    findings.push_back({"poses in which faces cross", crossed,
                        Concatenate("of ", report->poses_checked, "; frame ", worst_frame, " has the most pairs, ",
                                    worst.size(), ", most of them ", MostCrossed(body, worst))});
  }
  return findings;
}

std::string TableOf(const std::vector<BodyFinding>& findings) {
  size_t width = 0, digits = 0;
  for (const BodyFinding& finding : findings) {
    width = std::max(width, finding.what.size());
    digits = std::max(digits, std::to_string(finding.count).size());
  }
  std::string text;
  for (const BodyFinding& finding : findings) {
    const std::string count = std::to_string(finding.count);
    text += "  " + finding.what + std::string(width - finding.what.size() + 2 + digits - count.size(), ' ') + count +
            "  " + finding.details + "\n";
  }
  return text;
}

/// Text of the repairs, and of the reasons why some faults remain.
std::string RepairText(const RepairBodySummary& repair) {
  std::string text = "mended: ";
  std::string separator;
  const auto add = [&](int count, const std::string& what) {
    if (count == 0) return;
    text += Concatenate(separator, count, " ", what);
    separator = ", ";
  };
  add(repair.turned_faces, "faces turned");
  add(repair.dropped_faces, "faces dropped");
  add(repair.merged_vertices, "vertices merged");
  add(repair.dropped_vertices, "vertices dropped");
  add(repair.filled_holes, "holes filled");
  text += repair.changed() ? "\n" : "nothing\n";
  if (repair.largest_merge_m > 0) {
    text += "merged vertices lay up to " + Fixed(repair.largest_merge_m * kMmPerMetre, 3) + " mm apart\n";
  }
  if (repair.renumbered_vertices()) {
    text +=
        "vertices have new numbers: what was stored by vertex (exported vertices, OBJ files) belongs to the old body; "
        "tracks fit both\n";
  }
  const auto left = [&](int count, const std::string& why) {
    if (count > 0) text += Concatenate("left: ", count, " ", why, "\n");
  };
  left(repair.vertices_that_part, "vertices at the place of another that shape or pose takes elsewhere");
  left(repair.vertices_in_use, "vertices in no face that joints or landmarks are computed from");
  left(repair.vertices_numbered_elsewhere,
       "vertices to merge or drop: UV files and keypoints name the vertices of this topology by number");
  return text;
}

}  // namespace

CheckBodyReport CheckBody(const CheckBodyRequest& request, const PipelineCallbacks& callbacks) {
  const SurfaceTools& tools = request.surface_tools;
  if (!request.track.empty() && !tools.crossing) {
    throw RequestError(
        "--track: crossing faces are found by bodyloom-cgal, which is not beside bodyloom "
        "(docs/your_own_body.md)");
  }
  RequireReadableBody(request.body);
  RequireReadable(request.track, "track");
  RequireDistinct({request.body, request.track}, {request.repair});
  RequireWritable(request.repair);
  std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  CheckMeshOptions options;
  options.same_place_m = request.same_place_mm / kMmPerMetre;
  const CheckMeshResult mesh = CheckMesh(body->data().v_template, body->data().faces, options);
  CheckBodyReport report;
  report.description = DescriptionOf(body->data(), mesh);
  report.findings = FindingsOf(mesh);
  if (!request.repair.empty()) {
    BodyModelData data = body->data();
    RepairBodyOptions repair;
    repair.same_place_m = options.same_place_m;
    repair.hole_faces = tools.hole_faces;
    repair.max_hole_edges = request.max_hole_edges;
    report.repair = RepairBody(repair, &data);
    report.repaired = true;
    report.out = request.repair;
    body = std::make_shared<const BodyModel>(std::move(data));
    report.left = FindingsOf(CheckMesh(body->data().v_template, body->data().faces, options));
  }
  report.crossing_checked = static_cast<bool>(tools.crossing);
  report.could_fill_holes = static_cast<bool>(tools.hole_faces);
  if (tools.crossing) {
    callbacks.Begin("looking for crossing faces");
    std::vector<BodyFinding>& findings = report.repaired ? report.left : report.findings;
    const std::vector<BodyFinding> crossings = CrossingsOf(*body, request, &report, callbacks);
    findings.insert(findings.end(), crossings.begin(), crossings.end());
  }
  if (report.repaired) SaveBodyCompact(request.repair, body->data());
  return report;
}

std::string ToText(const CheckBodyReport& report) {
  std::string text = report.description + "\n";
  text += report.findings.empty() ? "nothing found\n" : "found:\n" + TableOf(report.findings);
  if (report.repaired) {
    text += RepairText(report.repair);
    text += report.left.empty() ? "nothing left\n" : "left:\n" + TableOf(report.left);
    text += "wrote " + report.out + "\n";
  }
  const char* holes = report.repaired && !report.could_fill_holes ? "; holes: not filled" : "";
  text += !report.crossing_checked
              ? Concatenate("crossing faces: not looked for", holes, " (bodyloom-cgal is not beside bodyloom)\n")
          : report.poses_checked > 0
              ? Concatenate("crossing faces: looked for at rest and in ", report.poses_checked, " poses\n")
              : "crossing faces: looked for at rest\n";
  return text;
}

}  // namespace bodyloom
