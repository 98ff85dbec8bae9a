// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <matio.h>

#include <filesystem>
#include <memory>
#include <sstream>

#include "data_tools/body/body_io.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/obj.h"
#include "tests/data_tools/body/small_body.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::body_io_uv_test {
namespace {

using ::testing::HasSubstr;

BodyModelData SmallBody() {
  const TemporaryFolder folder;
  WriteNpz(folder.File("model.npz"), OfficialNpz(MakeBodyArrays(50, 24, 1, false)));
  return LoadBodyData(folder.File("model.npz"));
}

/// An OBJ of the body: vertex i has UV (i / 100, i / 50); faces in reverse order, each started at another corner.
std::string ObjOf(const BodyModelData& body) {
  std::ostringstream text;
  text << "# a comment\no body\n";
  for (Eigen::Index v = 0; v < body.v_template.rows(); ++v) text << "v " << body.v_template.row(v) << "\n";
  for (Eigen::Index v = 0; v < body.v_template.rows(); ++v) text << "vt " << v / 100.0 << " " << v / 50.0 << "\r\n";
  text << "vn 0 0 1\ns off\nusemtl skin\n";
  for (Eigen::Index f = body.faces.rows(); f-- > 0;) {
    text << "f";
    for (int c = 0; c < 3; ++c) {
      const int v = body.faces(f, (c + 1) % 3) + 1;
      text << " " << v << "/" << v << "/1";
    }
    text << "\n";
  }
  return text.str();
}

void ExpectUvOfObj(const BodyModelData& body) {
  ASSERT_EQ(body.ft.rows(), body.faces.rows());
  for (Eigen::Index i = 0; i < body.faces.size(); ++i) {
    const int v = body.faces.data()[i], u = body.ft.data()[i];
    ASSERT_FLOAT_EQ(body.vt(u, 0), static_cast<float>(v / 100.0));
    ASSERT_FLOAT_EQ(body.vt(u, 1), static_cast<float>(v / 50.0));
  }
}

TEST(UvFromObj, MatchesFacesByTheirVertices) {
  BodyModelData body = SmallBody();
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("uv.obj"), ObjOf(body));
  UvFromObj(folder.File("uv.obj"), &body);
  ExpectUvOfObj(body);
  EXPECT_TRUE(BodyModel(body).has_uv());
}

TEST(UvFromObj, QuadsMatchEitherDiagonal) {
  BodyModelData body = SmallBody();
  std::string text = ObjOf(body);
  text.erase(text.find("\nf ") + 1);
  for (Eigen::Index f = 0; f < body.faces.rows(); f += 2) {
    // The two triangles (a, b, c), (a, c, d) of a quad, given as (b, c, d, a).
    std::ostringstream line;
    for (const int v : {body.faces(f, 1), body.faces(f, 2), body.faces(f + 1, 2), body.faces(f, 0)}) {
      line << " " << v + 1 << "/" << v - 50;  // UV by its distance from the last
    }
    text += "f" + line.str() + "\n";
  }
  const TemporaryFolder folder;
  WriteFileAtomically(folder.File("uv.obj"), text);
  UvFromObj(folder.File("uv.obj"), &body);
  ExpectUvOfObj(body);
}

TEST(UvFromObj, RefusesOtherMeshes) {
  const BodyModelData body = SmallBody();
  const std::string good = ObjOf(body);
  const TemporaryFolder folder;
  const std::string path = folder.File("uv.obj");
  const auto error_of = [&](const std::string& text) {
    WriteFileAtomically(path, text);
    BodyModelData copy = body;
    std::string message = FileErrorOf(path, [&] { UvFromObj(path, &copy); });
    EXPECT_EQ(copy.ft.rows(), 0) << "a failure leaves the body as it was";
    return message;
  };
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  EXPECT_THAT(error_of("v 0 0 0\n" + good), HasSubstr("51 vertices, expected the body's 50"));
  EXPECT_THAT(error_of(good.substr(0, good.rfind("\nf ") + 1)), HasSubstr("no face with the vertices"));
  EXPECT_THAT(error_of(replaced("vt 0 0", "vt 0 1.5")), HasSubstr("expected 0 to 1"));
  std::ostringstream bare;  // the first face of the body once more, without texture coordinates
  bare << "f " << body.faces(0, 0) + 1 << " " << body.faces(0, 1) + 1 << " " << body.faces(0, 2) + 1 << "\n";
  EXPECT_THAT(error_of(good + bare.str()), HasSubstr("face 81 has no texture coordinates"));
}

TEST(Obj, MalformedLinesAreNamed) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
  const auto error_of = [&](const std::string& line) {
    return FileErrorOf("x.obj: line 5", [&] { ReadObjBytes(start + line + "\n", "x.obj"); });
  };
  EXPECT_THAT(error_of("v 1 2"), HasSubstr("expected 3 finite numbers"));
  EXPECT_THAT(error_of("v 1 2 x"), HasSubstr("'x'"));
  EXPECT_THAT(error_of("v 1 2 nan"), HasSubstr("finite"));
  EXPECT_THAT(error_of("vt inf 2"), HasSubstr("finite"));
  EXPECT_THAT(error_of("v 1 2 1e999"), HasSubstr("finite"));
  EXPECT_THAT(error_of("f 1 2"), HasSubstr("fewer than three"));
  EXPECT_THAT(error_of("f"), HasSubstr("fewer than three"));
  EXPECT_THAT(error_of("f 1 2 4"), HasSubstr("names vertex 4, expected 1..3"));
  EXPECT_THAT(error_of("f 1 2 0"), HasSubstr("names vertex 0"));
  EXPECT_THAT(error_of("f 1 2 -4"), HasSubstr("names vertex -4"));
  EXPECT_THAT(error_of("f 1 2 99999999999"), HasSubstr("number of a vertex"));
  EXPECT_THAT(error_of("f 1/1 2/1 3/2"), HasSubstr("texture coordinate 2, expected 1..1"));
  EXPECT_THAT(error_of("f 1/1 2/1 3/-2147483648"), HasSubstr("texture coordinate"));
  EXPECT_THAT(error_of("f 1 2 3x"), HasSubstr("'3x'"));
}

TEST(Obj, PassesOverEverythingElse) {
  const ObjMesh mesh =
      ReadObjBytes("mtllib a.mtl\n\n  v 0 0 0 1 1 1\n\tv 1 0 0\nv 0 1 0\nf -3//1 -2// -1\ng x\nf 1 2 3", "x.obj");
  EXPECT_EQ(mesh.positions.rows(), 3);
  EXPECT_EQ(mesh.num_faces(), 2);
  EXPECT_EQ(mesh.corner_position, (std::vector<int>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(mesh.corner_uv, std::vector<int>(6, -1));
  EXPECT_EQ(ReadObjBytes("", "x.obj").num_faces(), 0);
}

// ---- DensePose's UV_Processed.mat ----

struct MatArrays {
  std::map<std::string, std::pair<std::pair<size_t, size_t>, std::vector<double>>> variables;

  void Write(const std::string& path) const {
    const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5),
                                                            &Mat_Close);
    for (const auto& [name, variable] : variables) {
      size_t dims[] = {variable.first.first, variable.first.second};
      std::vector<double> values = variable.second;
      const std::unique_ptr<matvar_t, decltype(&Mat_VarFree)> data(
          Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims, values.data(), 0), &Mat_VarFree);
      Mat_VarWrite(file.get(), data.get(), MAT_COMPRESSION_ZLIB);
    }
  }
};

/// The body's faces but the last two, each corner its own DensePose point: point k of face f is (f, k) in reverse
/// corner order, with U = point / 1000 and V = 1 − U; part f % 24 + 1.
MatArrays DensePoseOf(const BodyModelData& body) {
  const auto F = static_cast<size_t>(body.faces.rows()) - 2;
  std::vector<double> faces(3 * F), parts, vertices, u, v;
  for (size_t f = 0; f < F; ++f) {
    parts.push_back(static_cast<double>(f % 24 + 1));
    for (size_t c = 0; c < 3; ++c) {
      faces[c * F + f] = static_cast<double>(vertices.size() + 1);
      vertices.push_back(body.faces(static_cast<Eigen::Index>(f), 2 - static_cast<int>(c)) + 1);
      u.push_back(static_cast<double>(u.size()) / 1000);
      v.push_back(1 - u.back());
    }
  }
  MatArrays mat;
  const size_t n = vertices.size();
  mat.variables = {{"All_Faces", {{F, 3}, faces}},
                   {"All_FaceIndices", {{F, 1}, parts}},
                   {"All_vertices", {{1, n}, vertices}},
                   {"All_U_norm", {{n, 1}, u}},
                   {"All_V_norm", {{n, 1}, v}}};
  return mat;
}

TEST(PartsFromUvProcessedMat, MatchesFacesAndCorners) {
  BodyModelData body = SmallBody();
  const TemporaryFolder folder;
  DensePoseOf(body).Write(folder.File("UV_Processed.mat"));
  const PartsSummary summary = PartsFromUvProcessedMat(folder.File("UV_Processed.mat"), &body);
  const auto F = static_cast<int>(body.faces.rows());
  EXPECT_EQ(summary.faces_with_part, F - 2);
  EXPECT_EQ(summary.faces_without_part, 2);
  EXPECT_EQ(body.face_part[F - 1], 0);
  for (int f = 0; f < F - 2; ++f) {
    ASSERT_EQ(body.face_part[f], f % 24 + 1);
    for (int c = 0; c < 3; ++c) {
      const float u = static_cast<float>((3 * f + 2 - c) / 1000.0);
      ASSERT_FLOAT_EQ(body.face_iuv(f, 2 * c), u);
      ASSERT_FLOAT_EQ(body.face_iuv(f, 2 * c + 1), 1 - u);
    }
  }
  EXPECT_TRUE(BodyModel(body).has_parts());
}

TEST(PartsFromUvProcessedMat, RefusesBrokenFiles) {
  const BodyModelData body = SmallBody();
  const MatArrays good = DensePoseOf(body);
  const TemporaryFolder folder;
  const std::string path = folder.File("UV_Processed.mat");
  const auto error_of_file = [&] {
    BodyModelData copy = body;
    std::string message = FileErrorOf(path, [&] { PartsFromUvProcessedMat(path, &copy); });
    EXPECT_TRUE(copy.face_part.empty());
    std::filesystem::remove(path);
    return message;
  };
  const auto error_of = [&](const std::string& name, size_t index, double value) {
    MatArrays mat = good;
    mat.variables.at(name).second.at(index) = value;
    mat.Write(path);
    return error_of_file();
  };
  EXPECT_THAT(error_of("All_Faces", 0, 0), HasSubstr("'All_Faces' holds 0, expected 1.."));
  EXPECT_THAT(error_of("All_Faces", 0, 1e9), HasSubstr("'All_Faces' holds 1e+09"));
  EXPECT_THAT(error_of("All_vertices", 0, 51), HasSubstr("'All_vertices' holds 51, expected 1..50"));
  EXPECT_THAT(error_of("All_FaceIndices", 0, 25), HasSubstr("expected 1..24"));
  EXPECT_THAT(error_of("All_U_norm", 0, NAN), HasSubstr("NaN"));
  for (const auto& [name, variable] : good.variables) {
    MatArrays mat = good;
    mat.variables.erase(name);
    mat.Write(path);
    EXPECT_THAT(error_of_file(), HasSubstr("no variable '" + name + "'"));
    mat.variables[name] = {{2, 2}, {1, 1, 1, 1}};
    mat.Write(path);
    EXPECT_THAT(error_of_file(), HasSubstr("'" + name + "' is 2x2"));
  }
  WriteFileAtomically(path, "not a MATLAB file");
  EXPECT_THAT(error_of_file(), HasSubstr("not a MATLAB"));
  FileErrorOf(path, [&] {
    BodyModelData copy = body;
    PartsFromUvProcessedMat(path, &copy);
  });
  good.Write(path);
  const std::string whole = ReadFileBytes(path);
  for (size_t n = 0; n + 200 < whole.size(); n += 61) {
    WriteFileAtomically(path, whole.substr(0, n));
    error_of_file();
  }
}

}  // namespace
}  // namespace bodyloom::body_io_uv_test
