// SPDX-License-Identifier: Apache-2.0
/// JSON output shared by the reports of all jobs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "data_tools/evaluation/room_physics.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/world_frame.h"
#include "tracking/detection/hands_and_face_detector.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// {"stage": seconds, …}
nlohmann::ordered_json ToJson(const StageSeconds& seconds);

/// {"source", "vertical_sigma_deg", "height_sigma_m", "camera_height_m", "world_from_camera": 4×4}
nlohmann::ordered_json ToJson(const WorldFrame& world);

/// {"frames", "hover_percent", "hover_unexplained_percent", "lowest_point_mm", "ground_penetration_p95_mm",
/// "ground_penetration_percent", "contact_slide_mps", "balance_measured_percent", "balance_outside_percent",
/// "balance_p95_mm", "lean_median_deg"}, on several levels "other_level_percent"
/// (data_tools/evaluation/room_physics.h); null without frames.
nlohmann::ordered_json ToJson(const RoomPhysics& room);

/// Adds "jumps": {"flights", "stature_m", "sigma_m", "assumed_m"} (tracking/room/flights.h) where there are some.
void AddJumps(const FlightSummary& flights, nlohmann::ordered_json* report);

/// Adds "hands": {"looked_for", "found", "hidden", "too_small", "not_seen", "at_other_hand"}, "faces": the same, and
/// "hands_and_faces_seconds"; or "hands_not_looked_for": why. Nothing when they were not wanted.
void AddHandsAndFaces(const HandsAndFaceSummary& summary, nlohmann::ordered_json* report);

/// Adds "left_hand", "right_hand" and "head", where hands and faces were given: {"fitted", "why", "frames_seen",
/// "iterations", "median_px", "size"}.
void AddFittedParts(const TrackSequenceSummary& summary, nlohmann::ordered_json* report);

/// Writes a report, whole or not at all; an empty path: none.
void WriteReport(const std::string& path, const nlohmann::ordered_json& report);

}  // namespace bodyloom
