// SPDX-License-Identifier: Apache-2.0
/// Readers of motions, one per format, which load_motion.h recognises.
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/motion/skeleton_motion.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// AMP / poselib motions: a .npy of one pickled object,
///   {rotation: {arr T×J×4}, root_translation: {arr T×3}, skeleton_tree: {node_names, parent_indices: {arr J},
///    local_translation: {arr J×3}}, is_local, fps}.
/// Quaternions are (x, y, z, w), relative to the parent when is_local; metres; z up, x forward, y left.
/// Source: NVIDIA IsaacGymEnvs, poselib/poselib/skeleton/skeleton3d.py.
/// Throws std::runtime_error naming `where`, the key, what it holds and what was expected.
SkeletonMotion AmpFromNpyBytes(const std::string& bytes, const std::string& where);

// Acclaim motion capture: a skeleton (.asf) and motions of it (.amc), plain or gzipped, as in the CMU database.
//
// A bone b has a rest direction and length in world axes, a frame C_b given by the Euler angles `axis` (applied in the
// order written: "XYZ" is Rz·Ry·Rx) and degrees of freedom M_b in that frame. With all rest frames parallel to the
// world its joint rotation is C_b·M_b·C_b⁻¹. A bone's joint is at its near end: joint "ltibia" is the left knee. A
// bone without degrees of freedom, or absent from the motion (fingers often are), stays at rest. Lengths stay in file
// units (CMU: 0.45⁻¹ inches). AMC has no frame rate; CMU's is 120 Hz. Source: Schafer, Acclaim skeleton file
// definition V1.10; mocap.cs.cmu.edu.

/// `asf_path` may be empty: then "<subject>.asf" or "<subject>.asf.gz" is searched in the motion's folder, the subject
/// being the motion's file name up to the first '_'.
SkeletonMotion ReadAsfAmc(const std::string& amc_path, const std::string& asf_path = "", double fps = 120);
/// Throws std::runtime_error naming the file and the line.
SkeletonMotion AsfAmcFromText(const std::string& asf, const std::string& asf_where, const std::string& amc,
                              const std::string& amc_where, double fps);

// Biovision hierarchies (.bvh, .bvh.gz): any skeleton, any order of channels.
//
// HIERARCHY names joints with offsets and channels; MOTION holds one line of numbers per frame, degrees. Rotation
// channels multiply in the order they are listed: "Zrotation Yrotation Xrotation" is Rz·Ry·Rx. The root's position
// channels are its position; position channels of other joints are ignored (bones keep their lengths). Units are those
// of the writer. Keywords and channels may be in small letters, "Frames:" and "Time:" need no blank behind them.
// Source: Meredith and Maddock, "Motion Capture File Formats Explained".

SkeletonMotion ReadBvh(const std::string& path);
/// Reads the whole frames that are there; if their number is not the stated one, `warnings`, when requested, gets a
/// line with both. Throws std::runtime_error "where: line N: …".
SkeletonMotion BvhFromText(const std::string& text, const std::string& where,
                           std::vector<std::string>* warnings = nullptr);

// DeepMimic motions (humanoid3d_*.txt, JSON): {"Loop": …, "Frames": [[…]·44]}.
//
// A frame is: its duration (s), root position (m), then unit quaternions (w, x, y, z) of root, chest, neck, right hip,
// [knee angle], right ankle, right shoulder, [elbow angle], and the same for the left side; knees and elbows turn
// about z. World: y up, x forward, z right; legs and arms hang at rest. The skeleton (joint offsets, metres) is fixed.
// Source: Peng et al., DeepMimic, data/motions and data/characters/humanoid3d.txt.

bool IsDeepMimicJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
SkeletonMotion DeepMimicFromJson(const JsonNode& document);

// AIST++ motions/<seq>.pkl: `smpl_poses` N×72 (or N×24×3) axis-angle, `smpl_trans` N×3, `smpl_scaling` (1).
//
// Vertices in the data set's world (centimetres, y up) are smpl_scaling · SMPL(θ, β = 0) + smpl_trans, so the motion
// of a metric SMPL body has trans = smpl_trans / smpl_scaling metres. The person in front of the (metric) cameras is
// smpl_scaling / 100 times that size. 60 frames a second. Source: google/aistplusplus_api loader.py.

inline constexpr double kAistFps = 60;  ///< of the recordings; not stated in their files

bool IsAistMotion(const PickleValue& file);
/// Returns smpl_scaling / 100: metres of the world per metre of the body. Throws as below.
double AistBodyScale(const PickleValue& file, const std::string& where);
/// Throws std::runtime_error naming `where`, the key, what it holds and what was expected.
Motion AistMotionFromPickle(const PickleValue& file, const std::string& where, double fps = kAistFps);

}  // namespace bodyloom
