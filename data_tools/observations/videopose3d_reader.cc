// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/detection_readers.h"

#include <utility>
#include <vector>

#include "data_tools/formats/object_npy.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "data_tools/observations/people.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

constexpr int64_t kMaxVideoPoseFrames = 1'000'000;

struct View {
  std::string name;     ///< "subject/action/camera"
  std::string subject;  ///< of which video_metadata has the size
  const NdArray* array = nullptr;
};

const PickleValue& RequireTable(const PickleValue& value, const std::string& where, const std::string& what) {
  if (value.kind != Kind::kDict || value.dict.empty())
    ThrowFileError(where, what + ": expected a table that is not empty");
  return value;
}

std::vector<View> ViewsOf(const PickleValue& positions, const std::string& where) {
  std::vector<View> views;
  for (const auto& [subject, actions] : RequireTable(positions, where, "positions_2d").dict) {
    for (const auto& [action, cameras] : RequireTable(*actions, where, "positions_2d: a subject").dict) {
      const std::string name = subject + "/" + action + "/";
      if (cameras->kind == Kind::kArray) {  // a list of equal arrays may have become one array
        ThrowFileError(where, "positions_2d: " + PrintableText(name) + ": one array of " + cameras->array.ShapeText() +
                                  ", expected a list of cameras");
      }
      for (size_t c = 0; c < cameras->items.size(); ++c) {
        const PickleValue& camera = *cameras->items[c];
        const bool is_right = camera.kind == Kind::kArray && camera.array.is_number() &&
                              camera.array.shape.size() == 3 && camera.array.shape[1] == 17 &&
                              camera.array.shape[2] == 2;
        if (!is_right) {
          ThrowFileError(where, Concatenate("positions_2d: ", PrintableText(name), c, ": ",
                                            camera.kind == Kind::kArray ? "shape " + camera.array.ShapeText()
                                                                        : std::string("no array"),
                                            ", expected frames x 17 x 2"));
        }
        views.push_back({name + std::to_string(c), subject, &camera.array});
      }
    }
  }
  return views;
}

const View& FindView(const std::vector<View>& views, const std::string& wanted, const std::string& where) {
  const View* found = nullptr;
  int matches = 0;
  std::vector<std::string> names;
  for (const View& view : views) {
    names.push_back(view.name);
    if (view.name == wanted) return view;
    // A part of the name, between slashes, is enough if only one view has it.
    if (!wanted.empty() && ("/" + view.name + "/").find("/" + wanted + "/") == std::string::npos) continue;
    found = &view;
    ++matches;
  }
  if (matches == 1) return *found;
  if (views.size() == 1) return views[0];  // `view` may be of the cameras' file
  ThrowFileError(where, (wanted.empty() ? std::string("no view chosen")
                         : matches == 0 ? "no view '" + PrintableText(wanted) + "'"
                                        : Concatenate(matches, " views '", PrintableText(wanted), "'")) +
                            "; the file has " + PrintableList(names));
}

/// The first landmark of metadata's list of those on the left; −1 if it has none.
double FirstOnTheLeft(const PickleValue& metadata) {
  const PickleValue* symmetry = metadata.Find("keypoints_symmetry");
  if (symmetry == nullptr || symmetry->items.empty()) return -1;
  const PickleValue& left = *symmetry->items[0];
  if (left.kind == Kind::kArray && left.array.is_number() && left.array.num_elements() > 0) {
    return left.array.ToDoubles()[0];
  }
  return left.items.empty() ? -1 : NumberOf(left.items[0].get());
}

const KeypointConvention& LayoutOf(const PickleValue& metadata, const std::string& wanted, const std::string& where) {
  const PickleValue* layout = metadata.Find("layout_name");
  const std::string name = layout != nullptr ? layout->text : "";
  const double left = FirstOnTheLeft(metadata);
  for (const KeypointConvention* convention : {&Coco17(), &Human36m17()}) {
    const bool is_coco = convention == &Coco17();
    if (wanted.empty() ? name == (is_coco ? "coco" : "h36m") || (name.empty() && left == (is_coco ? 1 : 4))
                       : wanted == convention->name) {
      return *convention;
    }
  }
  if (!wanted.empty()) ThrowFileError(where, "convention '" + wanted + "', expected coco17 or human36m17");
  ThrowFileError(where, (name.empty() ? std::string("metadata without 'layout_name'")
                                      : "layout_name '" + PrintableText(name) + "'") +
                            ", which does not tell the order of the landmarks; give it (--convention coco17 or "
                            "human36m17)");
}

void ReadImageSize(const PickleValue& metadata, const std::string& subject, KeypointSequence* sequence) {
  const PickleValue* videos = metadata.Find("video_metadata");
  const PickleValue* video = videos != nullptr ? videos->Find(subject) : nullptr;
  if (video == nullptr) return;
  const double w = NumberOf(video->Find("w")), h = NumberOf(video->Find("h"));
  if (!(w >= 1 && w <= 100000 && h >= 1 && h <= 100000)) return;
  sequence->image_width = static_cast<int>(w);
  sequence->image_height = static_cast<int>(h);
}

}  // namespace

bool IsVideoPose3d(const NpzArrays& arrays) {
  const auto found = arrays.find("positions_2d");
  return found != arrays.end() && found->second.dtype == DType::kOther;
}

KeypointSequence VideoPose3dFromNpz(const std::string& bytes, const std::string& where, const std::string& view,
                                    double fps, const std::string& convention) {
  return VideoPose3dFromObjects(*ReadObjectOfNpz(bytes, "positions_2d", where),
                                *ReadObjectOfNpz(bytes, "metadata", where), where, view, fps, convention);
}

KeypointSequence VideoPose3dFromObjects(const PickleValue& positions, const PickleValue& metadata,
                                        const std::string& where, const std::string& view, double fps,
                                        const std::string& convention) {
  const std::vector<View> views = ViewsOf(positions, where);
  const View& chosen = FindView(views, view, where);
  const KeypointConvention& layout = LayoutOf(metadata, convention, where);
  const int64_t num_frames = chosen.array->shape[0];
  if (num_frames < 1 || num_frames > kMaxVideoPoseFrames) {
    ThrowFileError(where, Concatenate("positions_2d: ", num_frames, " frames, expected 1 to ", kMaxVideoPoseFrames));
  }
  KeypointSequence sequence;
  sequence.convention = layout.name;
  sequence.names = layout.names;
  ReadImageSize(metadata, chosen.subject, &sequence);
  const std::vector<double> values = chosen.array->ToDoubles();
  for (int64_t t = 0; t < num_frames; ++t) sequence.timestamps.push_back(static_cast<double>(t) / fps);
  for (size_t i = 0; i + 1 < values.size(); i += 2) {
    sequence.points.push_back(DetectedKeypoint(values[i], values[i + 1], 1));
  }
  return sequence;
}

}  // namespace bodyloom
