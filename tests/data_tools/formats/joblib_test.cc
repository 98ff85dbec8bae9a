// SPDX-License-Identifier: Apache-2.0
/// Pickles of joblib.dump, which hold arrays between opcodes.
#include <gmock/gmock.h>

#include "data_tools/formats/pickle.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/joblib_stream.h"

namespace bodyloom::joblib_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Kind = PickleValue::Kind;
using namespace joblib_stream;  // NOLINT(google-build-using-namespace)
using std::string_literals::operator""s;

PicklePtr Read(const std::string& bytes) { return ReadPickle(bytes, "p.pkl"); }
std::string ErrorOf(const std::string& bytes) {
  return FileErrorOf("p.pkl: byte ", [&] { ReadPickle(bytes, "p.pkl"); });
}

/// joblib 1.2.0 on Python 3.11, joblib.dump(r): r = defaultdict(dict), r[np.int64(3)] = {'pose': float32 2x3 of 0..5,
/// 'f': the same as big-endian float64 in Fortran's order, 's': np.float64(2.5), 'e': int64 of shape 0x3}.
std::string GenuineFile() {
  return "\x80\x04\x95"
         "c\x01\x00\x00\x00\x00\x00\x00\x8c\x0b"
         "collections\x94\x8c\x0b"
         "defaultdict\x94\x93"
         "\x94\x8c\x08"
         "builtins\x94\x8c\x04"
         "dict\x94\x93\x94\x85\x94R\x94\x8c\x15numpy.core.multiarray\x94"
         "\x8c\x06scalar\x94\x93\x94\x8c\x05numpy\x94\x8c\x05"
         "dtype\x94\x93\x94\x8c\x02i8\x94\x89\x88\x87\x94"
         "R\x94(K\x03\x8c\x01<\x94NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94"
         "bC\x08\x03\x00\x00\x00\x00"
         "\x00\x00\x00\x94\x86\x94R\x94}\x94(\x8c\x04pose\x94\x8c\x13joblib.numpy_pickle\x94\x8c\x11NumpyAr"
         "rayWrapper\x94\x93\x94)\x81\x94}\x94(\x8c\x08subclass\x94h\x0b\x8c\x07ndarray\x94\x93\x94\x8c\x05"
         "shape\x94K\x02K\x03\x86\x94\x8c\x05order\x94\x8c\x01"
         "C\x94h\x0ch\x0d\x8c\x02"
         "f4\x94\x89\x88\x87"
         "\x94R\x94(K\x03h\x11NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94"
         "b\x8c\x0a"
         "allow_mmap\x94\x88"
         "\x8c\x1bnumpy_array_alignment_bytes\x94K\x10ub\x01\xff\x00\x00\x00\x00\x00\x00\x80\x3f\x00\x00\x00"
         "@\x00\x00@@\x00\x00\x80@\x00\x00\xa0@\x95O\x00\x00\x00\x00\x00\x00\x00\x8c\x01"
         "f\x94h\x1a)\x81\x94"
         "}\x94(h\x1dh\x1fh K\x02K\x03\x86\x94h\x22\x8c\x01"
         "F\x94h\x0ch\x0d\x8c\x02"
         "f8\x94\x89\x88\x87\x94"
         "R\x94(K\x03\x8c\x01>\x94NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94"
         "bh(\x88h)K\x10ub\x0f\xff"
         "\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x00\x00\x00\x00\x00\x00\x00\x00@\x08\x00"
         "\x00\x00\x00\x00\x00\x3f\xf0\x00\x00\x00\x00\x00\x00@\x10\x00\x00\x00\x00\x00\x00@\x00\x00\x00\x00"
         "\x00\x00\x00@\x14\x00\x00\x00\x00\x00\x00\x95"
         "b\x00\x00\x00\x00\x00\x00\x00\x8c\x01s\x94h\x0ah\x0d"
         "\x8c\x02"
         "f8\x94\x89\x88\x87\x94R\x94(K\x03h\x11NNNJ\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94"
         "b"
         "C\x08\x00\x00\x00\x00\x00\x00\x04@\x94\x86\x94R\x94\x8c\x01"
         "e\x94h\x1a)\x81\x94}\x94(h\x1dh\x1fh"
         " K\x00K\x03\x86\x94h\x22h#h\x0ch\x10h(\x88h)K\x10ub\x04\xff\xff\xff\xffus."s;
}

void ExpectGenuine(const PickleValue& file) {
  const PickleValue* person = file.Find("3");
  ASSERT_NE(person, nullptr);
  EXPECT_EQ(RequireNumbers(*person, "pose", "p").ShapeText(), "2x3");
  EXPECT_THAT(RequireNumbers(*person, "pose", "p").ToDoubles(), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(RequireNumbers(*person, "f", "p").ShapeText(), "2x3");
  EXPECT_THAT(RequireNumbers(*person, "f", "p").ToDoubles(), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_EQ(person->Find("s")->real, 2.5);
  EXPECT_EQ(RequireNumbers(*person, "e", "p").ShapeText(), "0x3");
}

TEST(Joblib, ReadsAGenuineFilePlainAndCompressed) {
  ExpectGenuine(*Read(GenuineFile()));
  const std::string packed = Compressed(GenuineFile());
  EXPECT_EQ(packed[0], '\x78');
  ExpectGenuine(*Read(packed));
  EXPECT_THAT(ErrorOf(packed.substr(0, packed.size() / 2)), HasSubstr("zlib stream is cut off"));
}

std::string TwoArrays(bool aligned) {
  return JoblibStream(aligned)
      .Add("}(" + Unicode("a"))
      .AddFloats({1, 2, 3}, {3, 1})
      .Add(Unicode("b"))
      .AddInts({7, 8})
      .Add(Unicode("c") + Int(5) + "u")
      .Finish();
}

TEST(Joblib, ArraysWithAndWithoutPadding) {
  for (const bool aligned : {true, false}) {
    const PicklePtr file = Read(TwoArrays(aligned));
    EXPECT_THAT(RequireNumbers(*file, "a", "p").ToDoubles(), ElementsAre(1, 2, 3));
    EXPECT_THAT(RequireNumbers(*file, "b", "p").ToInts(), ElementsAre(7, 8));
    EXPECT_EQ(file->Find("c")->integer, 5);
  }
}

TEST(Joblib, RefusesWhatIsCutOffOrLies) {
  const std::string good = TwoArrays(true);
  for (size_t size = 2; size < good.size(); ++size) ErrorOf(good.substr(0, size));
  const auto with_array = [](const std::string& dtype, const std::vector<int>& shape) {
    return JoblibStream().AddArray(dtype, '<', shape, std::string(8, 'x')).Finish();
  };
  EXPECT_THAT(ErrorOf(with_array("f4", {3})), HasSubstr("its shape needs 12 bytes, the file holds 9"));
  EXPECT_THAT(ErrorOf(with_array("f4", {1 << 30, 1 << 30, 1 << 30})), HasSubstr("needs too many bytes"));
  EXPECT_THAT(ErrorOf(with_array("f4", {-1})), HasSubstr("expected sizes"));
  EXPECT_THAT(ErrorOf(with_array("O8", {1})), HasSubstr("element type"));
  const std::string wrapper = Global("joblib.numpy_pickle", "NumpyArrayWrapper") + ")\x81";
  EXPECT_THAT(ErrorOf(Pickle(4, wrapper + Dict({{Unicode("subclass"), Global("numpy", "dtype")}}) + "b")),
              HasSubstr("expected a numpy.ndarray"));
  EXPECT_THAT(ErrorOf(Pickle(4, wrapper + "}b")), HasSubstr("no 'subclass'"));
}

TEST(Joblib, AClassThatIsNamedButNotAnArrayIsRefused) {
  EXPECT_THAT(ErrorOf(Pickle(4, Global("torch._utils", "_rebuild_tensor_v2"))), HasSubstr("nothing was executed"));
  EXPECT_THAT(ErrorOf(Pickle(4, Global("builtins", "dict") + Tuple({"]"}) + "R")), HasSubstr("dict called with"));
}

}  // namespace
}  // namespace bodyloom::joblib_test
