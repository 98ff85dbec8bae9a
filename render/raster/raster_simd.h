// SPDX-License-Identifier: Apache-2.0
/// The inner loops of render/raster/visibility_buffer.h: plain arrays in, plain arrays out. No Eigen in here, because
/// these loops are compiled once per instruction set (SSE4, AVX2, AVX-512, …) and the best one is chosen at run time.
///
/// Every operation is exact or one correctly rounded IEEE operation, in an order written down here and never fused, so
/// all instruction sets give the same bits.
///
/// Coverage. Corners are in 1/256 px. The edge function of p → q at a pixel centre, (q − p) × (pixel − p), is an
/// integer, positive inside a face of positive area; `bias` is 1 for edges that do not own their pixels (top-left rule)
/// and is subtracted, so that a pixel is inside when no edge value is negative.
///
/// Nearness of a covered pixel, with e_b, e_c the biased edge values opposite to corners b and c:
///   slope_b = (n_b − n_a) / area,  slope_c = (n_c − n_a) / area
///   nearness = (n_a + (bias_b·slope_b + bias_c·slope_c)) + (e_b·slope_b + e_c·slope_c)
/// This is a mean of the corners' values with integer weights, so it stays within their range up to rounding for any
/// face. Small faces: every operation in float (integers are rounded to it first). Large ones: in double, rounded once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom {

/// A projected vertex, not rounded, without lens distortion.
struct ProjectedVertex {
  double x_px, y_px;
  double nearness;  ///< 1/z, or −z for weak perspective; NaN: behind the near plane, outside the lens or guard band
  double spare;     ///< padding to half a cache line
};

}  // namespace bodyloom

namespace bodyloom::raster_internal {

inline constexpr int kSubpixels = 256;
inline constexpr double kGuardBandPx =
    1 << 21;  ///< 2^29 subpixels: sums of two products of differences stay below 2^62
inline constexpr int kTileWidth = 64, kTileHeight = 32;
inline constexpr int kLanes = 16;  ///< widest vector; arrays that kernels write are padded by as many entries

/// pixel = scale · (X·w + offset) + centre with w = 1/Z (pinhole without distortion; offset 0) or w = 1 (weak).
struct Projection {
  bool divide_by_depth = true;
  double scale_x = 1, scale_y = 1, offset_x = 0, offset_y = 0, centre_x = 0, centre_y = 0;
  double near_m = 0;
};

inline constexpr int32_t kUnusable = INT32_MIN;  ///< x of a vertex behind the near plane or outside the guard band

struct ScreenVertex {
  int32_t x, y;    ///< rounded to 1/256 px
  float nearness;  ///< 1/z, or −z for weak perspective
  int32_t spare;   ///< padding to a single load
};

/// Output arrays, indexed by vertex.
struct ScreenArrays {
  ProjectedVertex* projected = nullptr;
  ScreenVertex* vertices = nullptr;
};

/// Bounds of a range of vertices; initially empty.
struct ScreenExtent {
  int32_t x_min = INT32_MAX, x_max = INT32_MIN, y_min = INT32_MAX, y_max = INT32_MIN;  ///< of the usable ones
  bool all_usable = true, all_finite = true;
};

/// Projects vertices first..last−1 (V×3 row-major, camera frame, metres). Pixels of unusable vertices are undefined.
void ProjectVertices(const Projection& projection, const double* vertices, int first, int last,
                     const ScreenArrays& screen, ScreenExtent* extent);

/// Returns true if all `count` values are in 0..bound−1.
bool AllInRange(const int32_t* values, int64_t count, int32_t bound);

/// The pixels that are drawn; faces' pixels are relative to its corner.
struct Box {
  int x_begin = 0, y_begin = 0, width = 0, height = 0;
};

/// Faces small enough for 32-bit edge functions, set up for drawing, ascending. Arrays have one entry per face.
struct SmallFaces {
  std::vector<int32_t> integers;
  std::vector<float> reals;
  int32_t *x_begin = nullptr, *y_begin = nullptr, *x_end = nullptr, *y_end = nullptr;  ///< pixels of the box
  int32_t* edge[3] = {};    ///< opposite corners a, b, c: biased value at (x_begin, y_begin)
  int32_t* step_x[3] = {};  ///< … its change by one pixel to the right
  int32_t* step_y[3] = {};  ///< … and down
  float *anchor = nullptr, *slope_b = nullptr, *slope_c = nullptr;
  int32_t* face = nullptr;
  int size = 0;
  void Reserve(int num_faces);
};

/// Any other face, including pieces of clipped ones.
struct LargeFace {
  ScreenVertex corners[3];
  int32_t face;
};

/// Sets up faces first..last−1 (F×3 row-major): culls those that face away (if requested), have no area or contain no
/// pixel centre of the box; appends small ones to `small`, and to `others` the indices of those that are large or have
/// an unusable corner.
void SetUpFaces(const int32_t* faces, int first, int last, const ScreenArrays& screen, const Box& box,
                bool cull_back_faces, SmallFaces* small, std::vector<int32_t>* others);

/// kTileWidth × kTileHeight pixels from (x, y) of the box.
struct Tile {
  int x = 0, y = 0;
  alignas(64) float nearness[kTileWidth * kTileHeight];
  alignas(64) int32_t face[kTileWidth * kTileHeight];
};

void ClearTile(Tile* tile);
/// Draws the given entries, whose faces must ascend; a face drawn earlier at equal nearness must have a lower index.
void DrawSmallFaces(const SmallFaces& faces, const int32_t* entries, int count, Tile* tile);
/// Draws the given faces in any order: at equal nearness the lower index wins.
void DrawLargeFaces(const LargeFace* faces, const int32_t* entries, int count, const Box& box, bool cull_back_faces,
                    Tile* tile);

/// Instruction sets of this build that this machine supports, best first.
std::vector<int64_t> SimdTargets();
std::string SimdTargetName(int64_t target);
/// Name of the one in use.
std::string ChosenSimdTarget();
/// For tests: restricts the process to one instruction set; 0 lifts the restriction. Must not be called while drawing.
void ForceSimdTarget(int64_t target);

}  // namespace bodyloom::raster_internal

namespace bodyloom {

// Finds the covered span of a row of a visibility buffer: most of a person's box is background, which is skipped eight
// pixels at a time.

/// Returns true if none of eight pixels sees a face.
inline bool SeeNothing(const int32_t* eight_faces) {
  int32_t all = eight_faces[0];
  for (int i = 1; i < 8; ++i) all &= eight_faces[i];  // −1 has every bit
  return all == -1;
}

/// Columns [begin, end) outside of which the row is background; both 0 for an empty row.
struct CoveredSpan {
  int begin = 0, end = 0;
};

inline CoveredSpan FindCoveredSpan(const int32_t* faces, int width) {
  int begin = 0, end = width;
  while (begin + 8 <= end && SeeNothing(faces + begin)) begin += 8;
  while (begin < end && faces[begin] < 0) ++begin;
  while (end - 8 >= begin && SeeNothing(faces + end - 8)) end -= 8;
  while (end > begin && faces[end - 1] < 0) --end;
  return begin < end ? CoveredSpan{begin, end} : CoveredSpan{};
}

}  // namespace bodyloom
