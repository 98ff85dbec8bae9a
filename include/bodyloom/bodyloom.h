// SPDX-License-Identifier: Apache-2.0
/// The headers that most programs use: bodies, cameras and tracks; readers of detections and videos; tracking of a
/// clip, offline and live, and its problem for Ceres; writers of descriptors, overlays and files. Networks
/// (bodyloom/neural/…) and pipelines (bodyloom/pipelines/…) are included by themselves.
#pragma once

#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/data_tools/descriptors/describe_track.h"
#include "bodyloom/data_tools/export/glb_writer.h"
#include "bodyloom/data_tools/motion/bvh_writer.h"
#include "bodyloom/data_tools/motion/motion_tools.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/data_tools/observations/load_detections.h"
#include "bodyloom/data_tools/observations/observations_npz.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/body/body_model.h"
#include "bodyloom/geometry/body/posed_body.h"
#include "bodyloom/geometry/math/rotation.h"
#include "bodyloom/geometry/scene/camera.h"
#include "bodyloom/geometry/scene/camera_path.h"
#include "bodyloom/geometry/scene/observations.h"
#include "bodyloom/geometry/scene/track.h"
#include "bodyloom/geometry/scene/world_frame.h"
#include "bodyloom/render/uv_maps/descriptor_frames.h"
#include "bodyloom/render/view/overlay.h"
#include "bodyloom/tracking/build_ceres_problem.h"
#include "bodyloom/tracking/live/live_tracker.h"
#include "bodyloom/tracking/track_sequence.h"
