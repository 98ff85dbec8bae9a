// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "data_tools/formats/pickle.h"

#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/joblib_stream.h"
#include "tests/data_tools/formats/pickle_writer.h"
#include "tests/support/paths.h"

namespace bodyloom::pickle_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Kind = PickleValue::Kind;
using namespace pickle_writer;  // NOLINT(google-build-using-namespace): opcodes read like the stream they build

PicklePtr Read(const std::string& bytes) { return ReadPickle(bytes, "p.pkl"); }
std::string ErrorOf(const std::string& bytes, const PickleLimits& limits = {}) {
  return FileErrorOf("p.pkl: byte ", [&] { ReadPickle(bytes, "p.pkl", limits); });
}
using std::string_literals::operator""s;

TEST(Pickle, ProtocolZeroText) {
  // pickle.dumps({'a': [1, 2.5, None, True, 10**20, -7L]}, 0) of Python 2.
  const PicklePtr value = Read("(dp0\nS'a'\np1\n(lp2\nI1\naF2.5\naNaI01\naL100000000000000000000L\naL-7L\nas.");
  const PickleValue* list = value->Find("a");
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->items.size(), 6U);
  EXPECT_EQ(list->items[0]->integer, 1);
  EXPECT_EQ(list->items[1]->real, 2.5);
  EXPECT_EQ(list->items[2]->kind, Kind::kNone);
  EXPECT_TRUE(list->items[3]->boolean);
  EXPECT_EQ(list->items[4]->real, 1e20);
  EXPECT_EQ(list->items[5]->integer, -7);
}

TEST(Pickle, ProtocolZeroStringsAndEscapes) {
  EXPECT_EQ(Read("S'a\\n\\x41\\'\\\\\\101'\n.")->text, "a\nA'\\A");
  EXPECT_EQ(Read("S\"it's\"\n.")->text, "it's");
  EXPECT_EQ(Read("V\\u20ac\xe9\\U0001F600\n.")->text, "\xe2\x82\xac\xc3\xa9\xf0\x9f\x98\x80");
  EXPECT_EQ(Read("V\\u0000a\\u0000\n.")->text, "\0a\0"s);
  for (const char* broken : {"S'a\n.", "Sa\n.", "S'\\x4'\n.", "S'\\q'\n.", "S'\\'\n.", "V\\u12\n.", "V\\uzzzz\n."}) {
    ErrorOf(broken);
  }
}

TEST(Pickle, BinaryNumbers) {
  EXPECT_EQ(Read("J\xfe\xff\xff\xff.")->integer, -2);
  EXPECT_EQ(Read("K\xfe.")->integer, 254);
  EXPECT_EQ(Read("M\x01\x02.")->integer, 513);
  EXPECT_EQ(Read("\x8a\x01\xff.")->integer, -1);
  EXPECT_EQ(Read("\x8a\x00."s)->integer, 0);
  EXPECT_EQ(Read("\x8a\x08\x00\x00\x00\x00\x00\x00\x00\x80."s)->integer, std::numeric_limits<int64_t>::min());
  EXPECT_EQ(Read("\x8a\x09\x00\x00\x00\x00\x00\x00\x00\x00\x01."s)->real, std::ldexp(1.0, 64));
  EXPECT_EQ(Read("\x8b\x09\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\xff."s)->real, -std::ldexp(1.0, 64));
  EXPECT_EQ(Read("G\x3f\xf8\x00\x00\x00\x00\x00\x00."s)->real, 1.5);
  EXPECT_TRUE(std::isnan(Read("Fnan\n.")->real));
}

TEST(Pickle, ProtocolFourOpcodes) {
  // pickle.dumps({'a': (1, b'x', 'é'), 'b': {1: frozenset([2])}}, 4), frame and memo included.
  const std::string body =
      "}\x94(\x8c\x01"
      "a\x94K\x01"
      "C\x01x\x94\x8c\x02\xc3\xa9\x94\x87\x94\x8c\x01"
      "b\x94}\x94K\x01(K\x02\x91\x94su.";
  const std::string bytes = "\x80\x04\x95" + LittleEndian(body.size(), 8) + body;
  const PicklePtr value = Read(bytes);
  const PickleValue* tuple = value->Find("a");
  ASSERT_EQ(tuple->items.size(), 3U);
  EXPECT_EQ(tuple->items[1]->kind, Kind::kBytes);
  EXPECT_EQ(tuple->items[2]->text, "\xc3\xa9");
  EXPECT_EQ(value->Find("b")->Find("1")->items[0]->integer, 2);
}

TEST(Pickle, DictionaryKeepsOrderAndLastValue) {
  const PicklePtr value = Read(Pickle(2, Dict({{Str2("b"), Int(1)}, {Str2("a"), Int(2)}, {Str2("b"), Int(3)}})));
  ASSERT_EQ(value->dict.size(), 2U);
  EXPECT_EQ(value->dict[0].first, "b");
  EXPECT_EQ(value->dict[0].second->integer, 3);
  EXPECT_EQ(value->dict[1].first, "a");
}

TEST(Pickle, NumpyArrayOfPython2) {
  const PicklePtr value = Read(Pickle(2, Doubles2({1, 2, 3, 4, 5, 6}, {3, 2})));
  ASSERT_EQ(value->kind, Kind::kArray);
  EXPECT_EQ(value->array.ShapeText(), "3x2");
  EXPECT_THAT(value->array.ToDoubles(), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(Pickle, NumpyByteOrderAndFortranOrder) {
  const PicklePtr big = Read(Pickle(2, Array2("i2", '>', {2}, false, std::string("\x01\x02\xff\xfe", 4))));
  EXPECT_THAT(big->array.ToInts(), ElementsAre(258, -2));
  const PicklePtr fortran = Read(Pickle(2, Array2("i4", '<', {2, 3}, true, RawOf<int32_t>({0, 10, 1, 11, 2, 12}))));
  EXPECT_THAT(fortran->array.ToInts(), ElementsAre(0, 1, 2, 10, 11, 12));
  const PicklePtr renamed = Read(Pickle(2, Array2("b1", '|', {2}, false, "\x01\x00"s, "numpy._core.multiarray")));
  EXPECT_THAT(renamed->array.ToInts(), ElementsAre(1, 0));
}

TEST(Pickle, NumpyArrayOfPython3) {
  // Protocol 2 of Python 3 carries bytes as latin-1 text in UTF-8; protocol 3 as bytes; protocol 5 in _frombuffer.
  const std::string data("\x00\x00\x00\x00\x00\x00\xf8\xbf", 8);
  const std::string utf8("\x00\x00\x00\x00\x00\x00\xc3\xb8\xc2\xbf", 10);
  const std::string encoded = Global("_codecs", "encode") + Tuple({Unicode(utf8), Unicode("latin1")}) + "R";
  for (const std::string& raw : {encoded, Bytes3(data)}) {
    const std::string array = Global("numpy.core.multiarray", "_reconstruct") +
                              Tuple({Global("numpy", "ndarray"), Tuple({Int(0)}), Bytes3("b")}) + "R" +
                              Tuple({Int(1), Shape({1}), Dtype2("f8", '<'), "\x89", raw}) + "b";
    EXPECT_THAT(Read(Pickle(3, array))->array.ToDoubles(), ElementsAre(-1.5));
  }
  const std::string in_band =
      Global("numpy._core.numeric", "_frombuffer") +
      Tuple({"\x96" + LittleEndian(8, 8) + data, Dtype2("f8", '<'), Shape({1, 1}), Unicode("C")}) + "R";
  const PicklePtr value = Read(Pickle(5, in_band));
  EXPECT_EQ(value->array.ShapeText(), "1x1");
  EXPECT_THAT(value->array.ToDoubles(), ElementsAre(-1.5));
}

TEST(Pickle, NumpyScalarsBecomeNumbers) {
  const auto scalar = [](const std::string& dtype, const std::string& data) {
    return Pickle(2, Global("numpy.core.multiarray", "scalar") + Tuple({Dtype2(dtype, '<'), Str2(data)}) + "R");
  };
  EXPECT_EQ(Read(scalar("f4", RawOf<float>({2.5F})))->real, 2.5);
  EXPECT_EQ(Read(scalar("i8", RawOf<int64_t>({-3})))->integer, -3);
  EXPECT_EQ(Read(scalar("b1", "\x01"))->kind, Kind::kBool);
  EXPECT_EQ(Read(scalar("S4", "male"))->text, "male");
  EXPECT_EQ(Read(scalar("u8", RawOf<uint64_t>({~uint64_t{0}})))->kind, Kind::kFloat);
}

TEST(Pickle, ObjectArrayBecomesList) {
  const std::string array = Global("numpy.core.multiarray", "_reconstruct") +
                            Tuple({Global("numpy", "ndarray"), Tuple({Int(0)}), Str2("b")}) + "R" +
                            Tuple({Int(1), Shape({2}), Dtype2("O8", '|'), "\x89", "](" + Int(4) + Str2("x") + "e"}) +
                            "b";
  const PicklePtr value = Read(Pickle(2, array));
  ASSERT_EQ(value->kind, Kind::kList);
  EXPECT_EQ(value->items[0]->integer, 4);
  EXPECT_EQ(value->items[1]->text, "x");
}

std::string Sparse(const std::string& module, const std::string& name, const std::vector<double>& data,
                   const std::vector<int32_t>& indices, const std::vector<int32_t>& indptr) {
  return Object2(module, name,
                 {{Str2("_shape"), Shape({2, 3})},
                  {Str2("data"), Doubles2(data, {static_cast<int>(data.size())})},
                  {Str2("indices"), Array2("i4", '<', {static_cast<int>(indices.size())}, false, RawOf(indices))},
                  {Str2("indptr"), Array2("i4", '<', {static_cast<int>(indptr.size())}, false, RawOf(indptr))}});
}

TEST(Pickle, SparseMatricesArriveDense) {
  // | 1 0 2 |
  // | 0 3 0 |
  const PicklePtr csc = Read(Pickle(2, Sparse("scipy.sparse.csc", "csc_matrix", {1, 3, 2}, {0, 1, 0}, {0, 1, 2, 3})));
  EXPECT_THAT(csc->array.ToDoubles(), ElementsAre(1, 0, 2, 0, 3, 0));
  const PicklePtr csr = Read(Pickle(2, Sparse("scipy.sparse._csr", "csr_matrix", {1, 2, 3}, {0, 2, 1}, {0, 2, 3})));
  EXPECT_THAT(csr->array.ToDoubles(), ElementsAre(1, 0, 2, 0, 3, 0));
}

TEST(Pickle, BrokenSparseMatricesAreRefused) {
  const auto refuse = [](const std::vector<int32_t>& indices, const std::vector<int32_t>& indptr,
                         const char* expected) {
    EXPECT_THAT(ErrorOf(Pickle(2, Sparse("scipy.sparse.csc", "csc_matrix", {1, 3, 2}, indices, indptr))),
                HasSubstr(expected));
  };
  refuse({0, 2, 0}, {0, 1, 2, 3}, "index 2, expected 0..1");
  refuse({0, -1, 0}, {0, 1, 2, 3}, "index -1");
  refuse({0, 1, 0}, {0, 1, 2, 4}, "indptr");
  refuse({0, 1, 0}, {0, 2, 1, 3}, "indptr");
  refuse({0, 1, 0}, {1, 1, 2, 3}, "indptr");
  refuse({0, 1, 0}, {0, 1, 3}, "indptr");
  const std::string huge = Object2("scipy.sparse.csc", "csc_matrix",
                                   {{Str2("_shape"), Shape({2147483647, 0})},
                                    {Str2("data"), Doubles2({}, {0})},
                                    {Str2("indices"), Doubles2({}, {0})},
                                    {Str2("indptr"), Doubles2({0}, {1})}});
  EXPECT_EQ(Read(Pickle(2, huge))->array.num_elements(), 0);
}

TEST(Pickle, SparseMatrixBeyondTheBudgetIsRefused) {
  // 2^31 rows x 1 column: 16 GiB dense out of a file of a kilobyte.
  const std::string tall = Object2("scipy.sparse.csc", "csc_matrix",
                                   {{Str2("_shape"), Shape({2147483647, 1})},
                                    {Str2("data"), Doubles2({}, {0})},
                                    {Str2("indices"), Doubles2({}, {0})},
                                    {Str2("indptr"), Doubles2({0, 0}, {2})}});
  EXPECT_THAT(ErrorOf(Pickle(2, tall)), HasSubstr("memory"));
}

TEST(Pickle, ChumpyObjectsBecomeArrays) {
  const std::string x = Doubles2({1, 2, 3, 4, 5, 6}, {2, 3});
  const std::string ch = Object2(
      "chumpy.ch", "Ch",
      {{Str2("_dirty_vars"), Global("__builtin__", "set") + Tuple({"](" + Str2("x") + "e"}) + "R"}, {Str2("x"), x}});
  const PicklePtr array = Read(Pickle(2, ch));
  ASSERT_EQ(array->kind, Kind::kArray);
  EXPECT_EQ(array->array.ShapeText(), "2x3");
  // v1.0 shapedirs: a slice of a longer array, x[:, :2].
  const std::string select = Object2("chumpy.reordering", "Select",
                                     {{Str2("a"), ch},
                                      {Str2("idxs"), Array2("i8", '<', {4}, false, RawOf<int64_t>({0, 1, 3, 4}))},
                                      {Str2("preferred_shape"), Shape({2, 2})}});
  const PicklePtr slice = Read(Pickle(2, select));
  EXPECT_EQ(slice->array.ShapeText(), "2x2");
  EXPECT_THAT(slice->array.ToDoubles(), ElementsAre(1, 2, 4, 5));
  const std::string outside =
      Object2("chumpy.reordering", "Select",
              {{Str2("a"), ch}, {Str2("idxs"), Array2("i8", '<', {1}, false, RawOf<int64_t>({6}))}});
  EXPECT_THAT(ErrorOf(Pickle(2, outside)), HasSubstr("index 6, expected 0..5"));
}

TEST(Pickle, OrderedDictBothForms) {
  const std::string pairs = "](](" + Str2("k") + Int(5) + "ee";
  const PicklePtr python2 = Read(Pickle(2, Global("collections", "OrderedDict") + Tuple({pairs}) + "R"));
  EXPECT_EQ(python2->Find("k")->integer, 5);
  const PicklePtr python3 = Read(Pickle(3, Global("collections", "OrderedDict") + ")R(" + Unicode("k") + Int(6) + "u"));
  EXPECT_EQ(python3->Find("k")->integer, 6);
}

TEST(Pickle, RefusesToNameFunctions) {
  const std::string attack = "cos\nsystem\n(S'echo hacked'\ntR.";
  const std::string message = ErrorOf(attack);
  EXPECT_THAT(message, HasSubstr("p.pkl: byte 0: the pickle names 'os.system'"));
  EXPECT_THAT(message, HasSubstr("nothing was executed"));
  EXPECT_THAT(ErrorOf("\x80\x04\x8c\x05posix\x8c\x06system\x93\x8c\x02id\x85R."),
              HasSubstr("byte 17: the pickle names 'posix.system'"));
  EXPECT_THAT(ErrorOf("(S'x'\nios\nsystem\n."), HasSubstr("os.system"));
  EXPECT_THAT(ErrorOf("cjoblib.numpy_pickle\nZNDArrayWrapper\n."), HasSubstr("joblib before 0.10"));
  for (const char* name :
       {"c__builtin__\neval\n.", "cbuiltins\nexec\n.", "cnumpy\nload\n.", "cnumpy.core.multiarray\nfromfile\n.",
        "cchumpy.ch\nMatVecMult\n.", "ccollections\nOrderedDict.fromkeys\n.", "c\n\n."}) {
    EXPECT_THAT(ErrorOf(name), HasSubstr("nothing was executed"));
  }
  EXPECT_THAT(ErrorOf("c\x01\x1b[2J\nx\n."), HasSubstr("'??[2J.x'"));
}

TEST(Pickle, RefusesWhatPointsOutsideTheFile) {
  for (const std::string& bytes :
       {"Pid\n."s, "NQ."s, "\x82\x01."s, "\x83\x01\x01."s, "\x84\x01\x01\x01\x01."s, "\x97."s, "\x98."s}) {
    ErrorOf(bytes);
  }
  EXPECT_THAT(ErrorOf("\x80\x06N."), HasSubstr("protocol 6"));
  EXPECT_THAT(ErrorOf("\x78\x9c\xff\xff\xff"), HasSubstr("zlib stream is damaged"));
  EXPECT_THAT(ErrorOf("\x1f\x8b\x08"), HasSubstr("gzip stream is cut off"));
}

TEST(Pickle, RefusesMisuseOfTheStack) {
  for (const char* bytes :
       {".",    "",       "0.",   "1.",   "2.",   "t.",      "\x85.", "a.",      "Na.",      "]NNs.", "}(Nu.",
        "NNs.", "N(NNu.", "R.",   "NNR.", "b.",   "NNb.",    "]}b.",  "h\x01.",  "g5\n.",    "gx\n.", "p1\n.",
        "(.",   "(o.",    "(No.", "e.",   "(Ne.", "NN\x93.", "}}s.",  "}((lNs.", "NN}\x92.", "(N1N0."}) {
    ErrorOf(bytes);
  }
}

TEST(Pickle, RefusesCyclesAndDepth) {
  EXPECT_THAT(ErrorOf("]q\x01h\x01"
                      "a."),
              HasSubstr("contains itself"));
  EXPECT_THAT(ErrorOf("}q\x01U\x01kh\x01s."), HasSubstr("contains itself"));
  const size_t n = 1'000'000;
  std::string nested(n, ']');
  nested += std::string(n - 1, 'a') + ".";
  EXPECT_THAT(ErrorOf(nested), HasSubstr("nested more than 200 levels"));
  EXPECT_THAT(ErrorOf(")" + std::string(n, '\x85') + "."), HasSubstr("nested"));
  EXPECT_THAT(ErrorOf(")" + std::string(n, '\x85') + "0N"), HasSubstr("STOP"));  // deep and thrown away
  EXPECT_EQ(Read(")" + std::string(n, '\x85') + "0N.")->kind, Kind::kNone);
  std::string allowed(199, ']');
  allowed += std::string(198, 'a') + ".";
  EXPECT_EQ(Read(allowed)->kind, Kind::kList);
  // The longest path counts, also when a shorter one reaches the same value first: [x, [[…[x]…]]] with x 150 deep.
  const auto shared = [](size_t wrapped) {
    return "]" + std::string(150, ']') + std::string(149, 'a') + "q\x01" + "a" + std::string(wrapped, ']') + "h\x01" +
           std::string(wrapped, 'a') + "a.";
  };
  EXPECT_EQ(Read(shared(40))->items.size(), 2U);
  EXPECT_THAT(ErrorOf(shared(60)), HasSubstr("nested more than 200 levels"));
}

TEST(Pickle, RefusesMoreMemoryThanTheFileDeserves) {
  // One megabyte of data, built into an array ten thousand times through the memo.
  std::string bytes = Str2(std::string(1 << 20, 'x')) + "r" + LittleEndian(1, 4) + "0" + Dtype2("S1", '|') +
                      "q\x02"
                      "0](";
  const std::string array = Global("numpy.core.multiarray", "_reconstruct") +
                            Tuple({Global("numpy", "ndarray"), Tuple({Int(0)}), Str2("b")}) + "R" +
                            Tuple({Int(1), Shape({1 << 20}), "h\x02", "\x89", "j" + LittleEndian(1, 4)}) + "b";
  for (int i = 0; i < 10000; ++i) bytes += array;
  PickleLimits limits;
  limits.max_bytes = size_t{256} << 20;
  EXPECT_THAT(ErrorOf(Pickle(2, bytes + "e"), limits), HasSubstr("memory"));
  limits = {};
  limits.max_items = 100;
  EXPECT_THAT(ErrorOf(std::string(200, ']') + ".", limits), HasSubstr("more than 100 values"));
}

TEST(Pickle, RefusesLyingLengths) {
  EXPECT_THAT(ErrorOf("T\xff\xff\xff\x7fxyz."), HasSubstr("expected 2147483647 more bytes, the file holds 4"));
  ErrorOf("\x8d\xff\xff\xff\xff\xff\xff\xff\xff.");
  ErrorOf("\x80\x04\x95\xff\xff\xff\xff\xff\xff\xff\xffN.");
  EXPECT_THAT(ErrorOf(Pickle(2, Array2("f8", '<', {536870912}, false, "12345678"))), HasSubstr("4294967296 bytes"));
  EXPECT_THAT(ErrorOf(Pickle(2, Array2("f8", '<', {2147483647, 2147483647, 2147483647}, false, "12345678"))),
              HasSubstr("too many"));
  ErrorOf(Pickle(2, Array2("f8", '<', {-1}, false, "12345678")));
  ErrorOf(Pickle(2, Array2("c16", '<', {1}, false, "1234567812345678")));
}

TEST(Pickle, RefusesEveryTruncation) {
  const std::string whole =
      Pickle(2, Dict({{Str2("a"), Doubles2({1, 2}, {2})},
                      {Str2("j"), Sparse("scipy.sparse.csc", "csc_matrix", {1, 3, 2}, {0, 1, 0}, {0, 1, 2, 3})},
                      {Str2("c"), Object2("chumpy.ch", "Ch", {{Str2("x"), Doubles2({1}, {1})}})}}));
  ASSERT_NO_THROW(Read(whole));
  for (size_t n = 0; n < whole.size(); ++n) ErrorOf(whole.substr(0, n));
}

TEST(Pickle, ReadsRealMotionFiles) {
  const std::filesystem::path folder = std::filesystem::path(SharedDir()) / "data/aistpp";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no AIST++ annotations at " << folder;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".pkl") continue;
    const PicklePtr value = ReadPickleFile(entry.path().string());
    ASSERT_EQ(value->kind, Kind::kDict) << entry.path();
    for (const auto& [key, item] : value->dict) {
      if (item->kind == Kind::kArray) {
        EXPECT_GT(item->array.num_elements(), 0) << entry.path() << " " << key;
      }
    }
    if (const PickleValue* poses = value->Find("smpl_poses")) {
      EXPECT_EQ(poses->array.shape[0], 576);
    }
    ++files;
  }
  EXPECT_EQ(files, 6);
}

using namespace joblib_stream;  // NOLINT(google-build-using-namespace)
using std::string_literals::operator""s;

std::string JoblibErrorOf(const std::string& bytes) {
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

// Pickles of joblib.dump, which hold arrays between opcodes.

TEST(Joblib, ReadsAGenuineFilePlainAndCompressed) {
  ExpectGenuine(*Read(GenuineFile()));
  const std::string packed = Compressed(GenuineFile());
  EXPECT_EQ(packed[0], '\x78');
  ExpectGenuine(*Read(packed));
  EXPECT_THAT(JoblibErrorOf(packed.substr(0, packed.size() / 2)), HasSubstr("zlib stream is cut off"));
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
  for (size_t size = 2; size < good.size(); ++size) JoblibErrorOf(good.substr(0, size));
  const auto with_array = [](const std::string& dtype, const std::vector<int>& shape) {
    return JoblibStream().AddArray(dtype, '<', shape, std::string(8, 'x')).Finish();
  };
  EXPECT_THAT(JoblibErrorOf(with_array("f4", {3})), HasSubstr("its shape needs 12 bytes, the file holds 9"));
  EXPECT_THAT(JoblibErrorOf(with_array("f4", {1 << 30, 1 << 30, 1 << 30})), HasSubstr("needs too many bytes"));
  EXPECT_THAT(JoblibErrorOf(with_array("f4", {-1})), HasSubstr("expected sizes"));
  EXPECT_THAT(JoblibErrorOf(with_array("O8", {1})), HasSubstr("element type"));
  const std::string wrapper = Global("joblib.numpy_pickle", "NumpyArrayWrapper") + ")\x81";
  EXPECT_THAT(JoblibErrorOf(Pickle(4, wrapper + Dict({{Unicode("subclass"), Global("numpy", "dtype")}}) + "b")),
              HasSubstr("expected a numpy.ndarray"));
  EXPECT_THAT(JoblibErrorOf(Pickle(4, wrapper + "}b")), HasSubstr("no 'subclass'"));
}

TEST(Joblib, AClassThatIsNamedButNotAnArrayIsRefused) {
  EXPECT_THAT(JoblibErrorOf(Pickle(4, Global("torch._utils", "_rebuild_tensor_v2"))),
              HasSubstr("nothing was executed"));
  EXPECT_THAT(JoblibErrorOf(Pickle(4, Global("builtins", "dict") + Tuple({"]"}) + "R")), HasSubstr("dict called with"));
}

}  // namespace

}  // namespace bodyloom::pickle_test
