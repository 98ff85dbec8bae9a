// SPDX-License-Identifier: Apache-2.0
// A person from photos. docs/python.md.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/photo_avatar/make_photo_person.h"
#include "pipelines/photo_avatar/person_folder.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"
#include "render/photo_avatar/transfer_clothes.h"

namespace bodyloom::python {
namespace {

constexpr const char* kPersonDoc =
    "A person from photos: a body that wears clothes, and a texture for it (`bodyloom animate person`).\n\n"
    "    me = bodyloom.Person.from_photos([\"me.jpg\"])\n"
    "    bodyloom.render(me.moved(\"dance.npz\"), what=\"texture\", body=me.body, texture=me.texture, out=\"me.mp4\")";
constexpr const char* kFromPhotosDoc =
    "The person of these photos; the first gives shape and clothes. Nothing is trained; the pose detector's\n"
    "networks have to be there (`./dev models`).\n\n"
    "who: of several people in a photo, 0 is the largest. texture_size: texels a side. body: a file; the built-in\n"
    "one by default. focal_px, stature_m: where they are known. models: folder of the networks. loose_garment:\n"
    "look for a skirt, dress or coat. Raises RuntimeError naming a photo that shows nobody or cannot be read,\n"
    "ValueError, Cancelled.";

constexpr const char* kParseDoc =
    "What each pixel of the person in a photo shows: (H, W) uint8, 0 background, 1 top, 2 bottom, 3 face, 4 hair,\n"
    "5 skin, 6 shoes (`bodyloom parse`). The pose detector's networks have to be there (`./dev models`).\n\n"
    "weights: \"builtin\", \"body\" (what the fitted body shows nearest), or a file of `bodyloom train parser`. The\n"
    "rest and what is raised: as Person.from_photos().";

/// Fit settings from the arguments of Person.from_photos() and parse_photo().
PhotoFitSettings FitOf(int who, const std::optional<Path>& body, std::optional<double> focal_px,
                       std::optional<double> stature_m, const std::optional<Path>& models) {
  BODYLOOM_CHECK(focal_px.value_or(1) > 0 && stature_m.value_or(1) > 0,
                 "focal_px, stature_m: expected numbers above 0");
  PhotoFitSettings fit;
  fit.person = who;
  fit.body = TextOf(body);
  fit.focal_px = focal_px.value_or(0);
  fit.stature_m = stature_m.value_or(0);
  fit.detector.models = TextOf(models);
  return fit;
}

class PersonObject {
 public:
  explicit PersonObject(PhotoPerson person) : person_(std::move(person)) {}

  [[nodiscard]] const PhotoPerson& person() const { return person_; }
  [[nodiscard]] std::shared_ptr<BodyModel> body() const { return std::const_pointer_cast<BodyModel>(person_.body); }
  [[nodiscard]] py::array texture() const { return ArrayFromImage(person_.texture); }
  [[nodiscard]] py::array labels() const {
    const bool known = !person_.labels.empty();
    return py::array_t<uint8_t>({known ? person_.texture.height : 0, known ? person_.texture.width : 0},
                                person_.labels.data());
  }
  [[nodiscard]] py::array light() const {
    const RowMatrixXd rows = person_.light.coefficients;
    return py::array_t<double>({rows.rows(), rows.cols()}, rows.data());
  }
  [[nodiscard]] std::shared_ptr<TrackObject> Moved(const TrackArgument& argument, bool own_stature) const {
    const std::shared_ptr<TrackObject> track = TrackFrom(argument);
    const PersonPlacing placed = own_stature ? PersonPlacing::kInScene : PersonPlacing::kInImage;
    return std::make_shared<TrackObject>(MovedByPerson(person_, TrackOnBody(*person_.body, track->track), placed),
                                         track->name, person_.body);
  }
  [[nodiscard]] std::map<std::string, double> shares() const {
    const PhotoPersonReport& report = person_.report;
    return {{"seen", report.seen},
            {"mirrored", report.mirrored},
            {"behind", report.behind},
            {"hair", report.hair},
            {"limb_neighbour", report.limb_neighbour},
            {"smooth_fill", report.smooth_fill}};
  }

 private:
  PhotoPerson person_;
};

}  // namespace

void BindPerson(py::module_& module) {
  py::class_<PersonObject>(module, "Person", kPersonDoc)
      .def_static(
          "from_photos",
          [](const std::vector<Path>& images, int who, int texture_size, const std::optional<Path>& body,
             std::optional<double> focal_px, std::optional<double> stature_m, const std::optional<Path>& models,
             bool loose_garment, const py::object& progress) {
            BODYLOOM_CHECK(!images.empty(), "images: expected at least one photo, found none");
            PhotoPersonRequest request;
            request.fit = FitOf(who, body, focal_px, stature_m, models);
            for (const Path& image : images) {
              RequireReadable(image.string(), "image");
              request.images.push_back(image.string());
            }
            request.texture_size = texture_size;
            request.loose_garment = loose_garment;
            return std::make_unique<PersonObject>(PythonCallbacks(progress).Run(
                [&](const PipelineCallbacks& callbacks) { return MakePhotoPerson(request, callbacks); }));
          },
          py::arg("images"), py::kw_only(), py::arg("who") = 0, py::arg("texture_size") = 1024,
          py::arg("body") = py::none(), py::arg("focal_px") = py::none(), py::arg("stature_m") = py::none(),
          py::arg("models") = py::none(), py::arg("loose_garment") = true, py::arg("progress") = py::none(),
          kFromPhotosDoc)
      .def_static(
          "load",
          [](const Path& folder, const std::optional<Path>& body) {
            return std::make_unique<PersonObject>(ReadPhotoPerson(folder.string(), TextOf(body)));
          },
          py::arg("folder"), py::kw_only(), py::arg("body") = py::none(),
          "A person who was kept: Person.save(), or `bodyloom animate person --keep`.")
      .def(
          "save",
          [](const PersonObject& self, const Path& folder) {
            RequireWritableFolder(folder.string());
            WritePhotoPerson(folder.string(), self.person());
          },
          py::arg("folder"), "Writes body.npz, texture.png, photo_0.npz ... and person.json into the folder.")
      .def("moved", &PersonObject::Moved, py::arg("track"), py::kw_only(), py::arg("own_stature") = false,
           "The motion by this person: a track of `body`, whose betas are zero. As tall in the image as\n"
           "whoever moved there; with own_stature as tall in the scene as the photos say.")
      .def(
          "wearing",
          [](const PersonObject& self, const PersonObject& other) {
            return std::make_unique<PersonObject>(TransferClothes(self.person(), other.person()));
          },
          py::arg("other"),
          "This person in the other one's clothes, a loose garment among them. Raises ValueError for people of\n"
          "different bodies, or who were kept before it was noted what their texels show.")
      .def_property_readonly("body", &PersonObject::body, "Clothed; zero betas are the person.")
      .def_property_readonly("texture", &PersonObject::texture,
                             "(S, S, 3) uint8, red green blue, as in even light; a copy.")
      .def_property_readonly(
          "labels", &PersonObject::labels,
          "(S, S) uint8, what each texel shows: 0 nothing, 1 top, 2 bottom, 3 face, 4 hair, 5 skin,\n"
          "6 shoes, a copy; (0, 0) where nobody knows.")
      .def_property_readonly(
          "light", &PersonObject::light,
          "(3, 9) copy: what the person is drawn in, camera frame; spherical harmonics up to order 2 of\n"
          "red, green and blue, shading = light @ basis(normal). Of the first photo, its mean 1 over the\n"
          "person.")
      .def_property_readonly(
          "betas",
          [](const py::object& self) { return MatrixView(self.cast<const PersonObject&>().person().betas, self); },
          "(B,) view: the shape on the body that the photos were fitted with.")
      .def_property_readonly(
          "shares", &PersonObject::shares,
          "Shares of the texture by where its colours are from: seen, mirrored, behind, hair, around,\n"
          "spread. Zeros for a person who was loaded.")
      .def("__repr__", [](const PersonObject& self) {
        return Concatenate("Person(", self.person().tracks.size(), " photos, texture ", self.person().texture.width,
                           "x", self.person().texture.height, ")");
      });
  module.def(
      "parse_photo",
      [](const Path& image, const std::string& weights, int who, const std::optional<Path>& body,
         std::optional<double> focal_px, std::optional<double> stature_m, const std::optional<Path>& models,
         const py::object& progress) {
        PhotoParseRequest request;
        request.fit = FitOf(who, body, focal_px, stature_m, models);
        RequireReadable(image.string(), "image");
        request.image = image.string(), request.weights = weights;
        const PhotoParseSummary parsed = PythonCallbacks(progress).Run(
            [&](const PipelineCallbacks& callbacks) { return ParsePhoto(request, callbacks); });
        return py::array_t<uint8_t>({parsed.height, parsed.width}, parsed.labels.data());
      },
      py::arg("image"), py::kw_only(), py::arg("weights") = kBuiltinParser, py::arg("who") = 0,
      py::arg("body") = py::none(), py::arg("focal_px") = py::none(), py::arg("stature_m") = py::none(),
      py::arg("models") = py::none(), py::arg("progress") = py::none(), kParseDoc);
}

}  // namespace bodyloom::python
