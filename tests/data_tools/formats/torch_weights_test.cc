// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/torch_weights.h"

#include <gmock/gmock.h>

#include <functional>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/pickle.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/data_tools/formats/torch_stream.h"

namespace bodyloom::torch_weights_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace torch_stream;  // NOLINT(google-build-using-namespace)

WeightsFile Read(const std::string& bytes) { return TorchWeightsFromBytes(bytes, "w.pth"); }
std::string ErrorOf(const std::string& bytes) {
  return FileErrorOf("w.pth", [&] { Read(bytes); });
}
/// The same object in both formats; count and bytes of the storages as given.
std::vector<std::string> BothOf(const std::function<std::string(bool legacy)>& object,
                                const std::vector<RawStorage>& storages) {
  return {Legacy(object(true), storages), Archive(object(false), storages)};
}
std::vector<std::string> SmallModels() {
  const SmallModel legacy = MakeSmallModel(true), zipped = MakeSmallModel(false);
  return {Legacy(legacy.object, legacy.storages), Archive(zipped.object, zipped.storages)};
}

TEST(TorchWeights, EveryTypeAndViewInBothFormats) {
  for (const std::string& bytes : SmallModels()) {
    const WeightsFile file = Read(bytes);
    const auto at = [&](const std::string& name) { return file.tensors.at("state_dict." + name); };
    EXPECT_EQ(file.tensors.size(), 14U);
    EXPECT_EQ(at("a.weight").ShapeText(), "3x4");
    EXPECT_EQ(at("a.weight").dtype, DType::kF32);
    EXPECT_THAT(at("a.weight").ToDoubles(), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
    EXPECT_EQ(at("a.transposed").ShapeText(), "4x3");
    EXPECT_THAT(at("a.transposed").ToDoubles(), ElementsAre(0, 4, 8, 1, 5, 9, 2, 6, 10, 3, 7, 11));
    EXPECT_THAT(at("a.window").ToDoubles(), ElementsAre(5, 6, 9, 10));
    EXPECT_THAT(at("a.expanded").ToDoubles(), ElementsAre(7, 7, 7, 7, 7, 7));
    EXPECT_EQ(at("a.empty").ShapeText(), "0x4");
    EXPECT_THAT(at("p").ToDoubles(), ElementsAre(1, -2));
    EXPECT_TRUE(at("scalar").shape.empty());
    EXPECT_THAT(at("scalar").ToInts(), ElementsAre(-7));
    EXPECT_EQ(at("HalfStorage").dtype, DType::kF16);
    EXPECT_THAT(at("HalfStorage").ToDoubles(), ElementsAre(1.5, -2));
    EXPECT_EQ(at("BFloat16Storage").dtype, DType::kBF16);
    EXPECT_THAT(at("BFloat16Storage").ToDoubles(), ElementsAre(1.5, -2));
    EXPECT_THAT(at("IntStorage").ToInts(), ElementsAre(1, -1));
    EXPECT_THAT(at("ShortStorage").ToInts(), ElementsAre(1, -1));
    EXPECT_THAT(at("CharStorage").ToInts(), ElementsAre(1, -1));
    EXPECT_THAT(at("ByteStorage").ToInts(), ElementsAre(1, 255));
    EXPECT_EQ(at("BoolStorage").dtype, DType::kBool);
    EXPECT_THAT(file.ignored, ElementsAre("epoch", "list"));
  }
}

TEST(TorchWeights, HalvesWidenOnRequestAlone) {
  TemporaryFolder folder;
  for (const std::string& bytes : SmallModels()) {
    WriteFileAtomically(folder.File("w.pth"), bytes);
    const WeightsFile file = ReadWeights(folder.File("w.pth"), {.widen_halves = true});
    for (const char* name : {"state_dict.HalfStorage", "state_dict.BFloat16Storage"}) {
      EXPECT_EQ(file.tensors.at(name).dtype, DType::kF32);
      EXPECT_THAT(file.tensors.at(name).ToDoubles(), ElementsAre(1.5, -2));
    }
    EXPECT_EQ(file.tensors.at("state_dict.p").dtype, DType::kF64);
    EXPECT_EQ(ReadTorchWeights(folder.File("w.pth")).tensors.at("state_dict.HalfStorage").dtype, DType::kF16);
  }
}

TEST(TorchWeights, FormsOf2017) {
  // _rebuild_tensor without gradient and hooks; a parameter by its class and state; a view of a storage.
  const std::string id = Tuple({Unicode("storage"), Global("torch", "FloatStorage"), Unicode("k"), Unicode("cuda:0"),
                                Int(4), Tuple({Unicode("v"), Int(1), Int(3)})}) +
                         "Q";
  const std::string tensor =
      Global("torch._utils", "_rebuild_tensor") + Tuple({id, Int(1), Tuple({Int(2)}), Tuple({Int(1)})}) + "R";
  const std::string parameter = Global("torch.nn.parameter", "Parameter") + Tuple({tensor}) + "R" +
                                Tuple({"\x88", "\x89", Global("collections", "OrderedDict") + ")R"}) + "b";
  const WeightsFile file = Read(Legacy(Dict({{Unicode("w"), parameter}}), {{"k", RawOf<float>({0, 10, 20, 30}), 4}}));
  EXPECT_THAT(file.tensors.at("w").ToDoubles(), ElementsAre(20, 30));
}

TEST(TorchWeights, LoneTensorAndArchiveWithoutFolder) {
  const std::string lone = Tensor(StorageId("FloatStorage", "0", 1, false), 0, {1}, {1});
  const std::string bytes = MakeZip({{"data.pkl", Pickle(2, lone)}, {"data/0", RawOf<float>({5})}});
  EXPECT_THAT(Read(bytes).tensors.at("tensor").ToDoubles(), ElementsAre(5));
}

TEST(TorchWeights, NothingRuns) {
  for (const std::string& attack :
       {Global("os", "system") + Tuple({Unicode("echo hacked")}) + "R", Global("torch", "load"),
        Global("torch.nn.modules.conv", "Conv2d"), Global("torch._utils", "_rebuild_qtensor"),
        Global("torch", "FloatStorage.from_file"), Global("numpy.core.multiarray", "_reconstruct"),
        Global("__builtin__", "set")}) {
    for (const std::string& bytes : {Legacy(attack, {}), Archive(attack, {})}) {
      EXPECT_THAT(ErrorOf(bytes), HasSubstr("nothing was executed (save the model's state_dict() alone)"));
    }
  }
  EXPECT_THAT(ErrorOf(Archive(Global("torch", "FloatStorage") + ")R", {})), HasSubstr("builds no data"));
  // Globals allowed in torch.save files remain unknown in other pickles.
  FileErrorOf("p.pkl", [] { ReadPickle(Pickle(2, Global("torch", "FloatStorage")), "p.pkl"); });
  FileErrorOf("p.pkl", [] { ReadPickle(Pickle(2, ")Q"), "p.pkl"); });
}

TEST(TorchWeights, ViewsMustLieInTheirStorage) {
  const auto refuse = [](int offset, const std::vector<int>& shape, const std::vector<int>& stride,
                         const char* expected) {
    const auto object = [&](bool legacy) {
      return Tensor(StorageId("FloatStorage", "0", 4, legacy), offset, shape, stride);
    };
    for (const std::string& bytes : BothOf(object, {{"0", RawOf<float>({0, 1, 2, 3}), 4}})) {
      EXPECT_THAT(ErrorOf(bytes), HasSubstr(expected));
    }
  };
  refuse(1, {2, 2}, {2, 1}, "reaches beyond its storage of 4 elements");
  refuse(0, {2, 2}, {3, 1}, "reaches beyond");
  refuse(4, {1}, {1}, "reaches beyond");
  refuse(2147483647, {}, {}, "reaches beyond");
  refuse(0, {3, 3}, {2147483647, 1}, "reaches beyond");
  refuse(0, {2147483647, 2147483647}, {2147483647, 2147483647}, "more memory");
  refuse(0, {2147483647}, {0}, "more memory");
  refuse(0, {2147483647, 2147483647, 2147483647}, {0, 0, 0}, "more memory");
  refuse(0, {2}, {1, 1}, "as many strides");
  refuse(-1, {1}, {1}, "at least 0");
  refuse(0, {-1}, {1}, "at least 0");
  refuse(0, {2}, {-1}, "at least 0");
  refuse(0, std::vector<int>(33, 1), std::vector<int>(33, 1), "at most 32");
}

TEST(TorchWeights, StoragesMustBeWhatTheirIdsSay) {
  const auto object = [](bool legacy) { return Tensor(StorageId("FloatStorage", "0", 4, legacy), 0, {1}, {1}); };
  const std::string raw = RawOf<float>({0, 1, 2, 3});
  for (const std::string& bytes : BothOf(object, {{"0", raw + "abc", 5}})) ErrorOf(bytes);
  for (const std::string& bytes : BothOf(object, {{"0", raw.substr(0, 12), 3}})) ErrorOf(bytes);
  for (const std::string& bytes : BothOf(object, {{"1", raw, 4}})) ErrorOf(bytes);
  for (const std::string& bytes : BothOf(object, {})) EXPECT_THAT(ErrorOf(bytes), HasSubstr("is not in the file"));
  EXPECT_THAT(ErrorOf(Legacy(object(true), {{"0", raw, ~uint64_t{0}}})), HasSubstr("18446744073709551615 elements"));
  EXPECT_THAT(ErrorOf(Legacy(object(true), {{"0", raw, 4}, {"0", raw, 4}})), HasSubstr("twice"));
  const std::string huge = Tensor(StorageId("FloatStorage", "0", 2147483647, true), 0, {1}, {1});
  EXPECT_THAT(ErrorOf(Legacy(huge, {{"0", raw, 2147483647}})), HasSubstr("the file holds 16 more bytes"));
}

TEST(TorchWeights, OtherFilesAreNamed) {
  const std::string object = Tensor(StorageId("FloatStorage", "0", 1, false), 0, {1}, {1});
  const std::vector<RawStorage> one = {{"0", RawOf<float>({1}), 1}};
  EXPECT_THAT(ErrorOf(Archive(object, one, {{"net/constants.pkl", "x"}})), HasSubstr("TorchScript"));
  EXPECT_THAT(ErrorOf(Archive(object, one, {{"net/byteorder", "big"}})), HasSubstr("byte order 'big'"));
  EXPECT_EQ(Read(Archive(object, one, {{"net/byteorder", "little"}})).tensors.size(), 1U);
  EXPECT_THAT(ErrorOf(MakeZip({{"a.npy", "x"}})), HasSubstr("no data.pkl"));
  EXPECT_THAT(ErrorOf("hello"), HasSubstr("expected a file of torch.save"));
  ErrorOf("");
  std::string wrong_magic = SmallModels()[0];
  wrong_magic[5] ^= 1;
  EXPECT_THAT(ErrorOf(wrong_magic), HasSubstr("magic"));
  std::string wrong_protocol = SmallModels()[0];
  wrong_protocol[18] = '\x04';
  EXPECT_THAT(ErrorOf(wrong_protocol), HasSubstr("expected 1001"));
}

TEST(TorchWeights, SharedDictionariesCannotGrowWithoutBound) {
  // Thirty dictionaries, each holding the one before twice: 2^30 paths.
  std::string object = "}q\x01" + Unicode("x") + Int(1) + "s";
  for (char level = 2; level < 32; ++level) {
    const std::string before = std::string("h") + static_cast<char>(level - 1);
    object += std::string("0}q") + level + "(" + Unicode("a") + before + Unicode("b") + before + "u";
  }
  EXPECT_THAT(ErrorOf(Archive(object, {})), HasSubstr("more than 200000 entries"));
}

TEST(TorchWeights, TruncationAtEveryByteIsRefused) {
  for (const std::string& bytes : SmallModels()) {
    for (size_t length = 0; length < bytes.size(); ++length) ErrorOf(bytes.substr(0, length));
  }
}

}  // namespace
}  // namespace bodyloom::torch_weights_test
