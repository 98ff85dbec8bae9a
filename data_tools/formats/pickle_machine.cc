// SPDX-License-Identifier: Apache-2.0
#include "data_tools/formats/pickle_machine.h"

#include <charconv>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Kind = PickleValue::Kind;

constexpr int kHighestProtocol = 5;
constexpr size_t kSlot = sizeof(PicklePtr);

/// The stack machine of pickletools: runs opcodes over a byte string until STOP.
class PickleMachine {
 public:
  PickleMachine(std::string_view bytes, PickleContext* context) : in_(bytes), context_(*context), at_(context->offset) {
    none_ = context_.New(Kind::kNone);
    true_ = context_.New(Kind::kBool);
    true_->boolean = true;
    false_ = context_.New(Kind::kBool);
  }

  PickleNodePtr Run() {
    for (;;) {
      context_.offset = at_;
      if (at_ >= in_.size()) context_.Fail("the pickle ends without its STOP mark, it is cut off");
      const auto opcode = static_cast<unsigned char>(in_[at_++]);
      if (opcode == '.') return Pop();
      if (!RunValue(opcode) && !RunContainer(opcode) && !RunMemo(opcode) && !RunObject(opcode)) ThrowFileError(opcode);
    }
  }

 private:
  // ---- bytes ----
  std::string_view Take(uint64_t n) {
    if (n > in_.size() - at_) {
      context_.Fail(Concatenate("expected ", n, " more bytes, the file holds ", in_.size() - at_));
    }
    const std::string_view taken = in_.substr(at_, n);
    at_ += n;
    return taken;
  }
  uint64_t TakeUnsigned(int n) {
    uint64_t value = 0;
    const std::string_view bytes = Take(static_cast<uint64_t>(n));
    for (int i = n; i-- > 0;) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
    return value;
  }
  std::string_view TakeLine() {
    const size_t end = in_.find('\n', at_);
    if (end == std::string_view::npos) context_.Fail("expected a line break, the file is cut off");
    const std::string_view line = in_.substr(at_, end - at_);
    at_ = end + 1;
    return line;
  }

  // ---- stack ----
  void Push(PickleNodePtr node) { stack_.push_back(std::move(node)); }
  PickleNodePtr Pop() {
    RequireAbove(1);
    PickleNodePtr node = std::move(stack_.back());
    stack_.pop_back();
    return node;
  }
  PickleNode& Top() {
    RequireAbove(1);
    return *stack_.back();
  }
  void RequireAbove(size_t n) const {
    const size_t floor = marks_.empty() ? 0 : marks_.back();
    if (stack_.size() < floor + n) context_.Fail("an opcode that needs more values than the stack holds");
  }
  /// Takes everything above the last mark, and the mark.
  std::vector<PickleNodePtr> PopMark() {
    if (marks_.empty()) context_.Fail("an opcode that needs a mark, there is none");
    const auto begin = stack_.begin() + static_cast<std::ptrdiff_t>(marks_.back());
    std::vector<PickleNodePtr> items(std::make_move_iterator(begin), std::make_move_iterator(stack_.end()));
    stack_.erase(begin, stack_.end());
    marks_.pop_back();
    return items;
  }

  // ---- values ----
  void PushInt(int64_t value) {
    PickleNodePtr node = context_.New(Kind::kInt);
    node->integer = value;
    Push(std::move(node));
  }
  void PushFloat(double value) {
    PickleNodePtr node = context_.New(Kind::kFloat);
    node->real = value;
    Push(std::move(node));
  }
  /// Text that stays in the file until the result needs it.
  void PushView(Kind kind, std::string_view view) {
    PickleNodePtr node = context_.New(kind);
    node->view = view;
    Push(std::move(node));
  }
  void PushText(std::optional<std::string> text) {
    if (!text) context_.Fail("a string that is not quoted or escaped as Python does it");
    context_.Charge(text->size());
    PickleNodePtr node = context_.New(Kind::kString);
    node->text = std::move(*text);
    Push(std::move(node));
  }
  /// Little-endian two's complement; beyond 64 bits the nearest float.
  void PushLong(std::string_view bytes) {
    if (bytes.size() <= 8) {
      uint64_t value = !bytes.empty() && (bytes.back() & 0x80) != 0 ? ~uint64_t{0} : 0;
      for (size_t i = bytes.size(); i-- > 0;) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
      return PushInt(static_cast<int64_t>(value));
    }
    double value = static_cast<double>(static_cast<signed char>(bytes.back()));
    for (size_t i = bytes.size() - 1; i-- > 0;) value = value * 256 + static_cast<unsigned char>(bytes[i]);
    PushFloat(value);
  }
  void PushDecimal(std::string_view text) {
    if (!text.empty() && text.back() == 'L') text.remove_suffix(1);
    int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc() && end == text.data() + text.size()) return PushInt(value);
    if (error == std::errc::result_out_of_range) return PushDecimalFloat(text);
    context_.Fail("expected a whole number, found '" + PrintableText(text) + "'");
  }
  void PushDecimalFloat(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if ((error != std::errc() && error != std::errc::result_out_of_range) || end != text.data() + text.size()) {
      context_.Fail("expected a number, found '" + PrintableText(text) + "'");
    }
    PushFloat(error == std::errc::result_out_of_range ? std::numeric_limits<double>::infinity() : value);
  }

  bool RunValue(unsigned char opcode) {
    switch (opcode) {
      case 'N':
        return Push(none_), true;
      case 0x88:
        return Push(true_), true;
      case 0x89:
        return Push(false_), true;
      case 'I': {
        const std::string_view line = TakeLine();
        if (line == "00" || line == "01") return Push(line == "01" ? true_ : false_), true;
        return PushDecimal(line), true;
      }
      case 'J':
        return PushInt(static_cast<int32_t>(TakeUnsigned(4))), true;
      case 'K':
        return PushInt(static_cast<int64_t>(TakeUnsigned(1))), true;
      case 'M':
        return PushInt(static_cast<int64_t>(TakeUnsigned(2))), true;
      case 'L':
        return PushDecimal(TakeLine()), true;
      case 0x8a:
        return PushLong(Take(TakeUnsigned(1))), true;
      case 0x8b:
        return PushLong(Take(TakeUnsigned(4))), true;
      case 'F':
        return PushDecimalFloat(TakeLine()), true;
      case 'G': {
        const std::string_view bytes = Take(8);
        uint64_t bits = 0;
        for (const char c : bytes) bits = (bits << 8) | static_cast<unsigned char>(c);
        double value = 0;
        std::memcpy(&value, &bits, sizeof(value));
        return PushFloat(value), true;
      }
      case 'S':
        return PushText(UnquotePython2(TakeLine())), true;
      case 'V':
        return PushText(DecodeRawUnicode(TakeLine())), true;
      case 'U':
      case 0x8c:
        return PushView(Kind::kString, Take(TakeUnsigned(1))), true;
      case 'T':
      case 'X':
        return PushView(Kind::kString, Take(TakeUnsigned(4))), true;
      case 0x8d:
        return PushView(Kind::kString, Take(TakeUnsigned(8))), true;
      case 'C':
        return PushView(Kind::kBytes, Take(TakeUnsigned(1))), true;
      case 'B':
        return PushView(Kind::kBytes, Take(TakeUnsigned(4))), true;
      case 0x8e:
      case 0x96:
        return PushView(Kind::kBytes, Take(TakeUnsigned(8))), true;
      default:
        return false;
    }
  }

  // ---- containers ----
  void PushTuple(size_t n) {
    RequireAbove(n);
    PickleNodePtr tuple = context_.New(Kind::kTuple);
    context_.Charge(n * kSlot);
    tuple->items.assign(std::make_move_iterator(stack_.end() - static_cast<std::ptrdiff_t>(n)),
                        std::make_move_iterator(stack_.end()));
    stack_.resize(stack_.size() - n);
    Push(std::move(tuple));
  }
  void PushItems(Kind kind, std::vector<PickleNodePtr> items) {
    PickleNodePtr node = context_.New(kind);
    context_.Charge(items.size() * kSlot);
    node->items.assign(std::make_move_iterator(items.begin()), std::make_move_iterator(items.end()));
    Push(std::move(node));
  }
  void Append(std::vector<PickleNodePtr> items) {
    PickleNode& list = Top();
    if (list.kind != Kind::kList) context_.Fail("items for something that is not a list");
    context_.Charge(items.size() * kSlot);
    list.items.insert(list.items.end(), std::make_move_iterator(items.begin()), std::make_move_iterator(items.end()));
  }
  std::string KeyText(const PickleNode& key) const {
    switch (key.kind) {
      case Kind::kString:
      case Kind::kBytes:
        return std::string(key.Text());
      case Kind::kInt:
        return std::to_string(key.integer);
      case Kind::kBool:
        return key.boolean ? "True" : "False";
      case Kind::kNone:
        return "None";
      default:
        context_.Fail("a dictionary key that is neither text nor a whole number");
    }
  }
  void SetItems(PickleNode* dict, const std::vector<PickleNodePtr>& items) {
    if (dict->kind != Kind::kDict) context_.Fail("items for something that is not a dictionary");
    if (items.size() % 2 != 0) context_.Fail("a dictionary key without a value");
    for (size_t i = 0; i < items.size(); i += 2) {
      context_.Charge(items[i]->Text().size() + sizeof(dict->dict[0]));
      dict->dict.emplace_back(KeyText(*items[i]), items[i + 1]);
    }
  }

  bool RunContainer(unsigned char opcode) {
    switch (opcode) {
      case '(':
        return marks_.push_back(stack_.size()), true;
      case '0':
        if (!marks_.empty() && marks_.back() == stack_.size()) {
          marks_.pop_back();
        } else {
          Pop();
        }
        return true;
      case '1':
        return PopMark(), true;
      case '2':
        RequireAbove(1);
        return Push(stack_.back()), true;
      case ')':
        return PushTuple(0), true;
      case 0x85:
      case 0x86:
      case 0x87:
        return PushTuple(opcode - 0x84U), true;
      case 't':
        return PushItems(Kind::kTuple, PopMark()), true;
      case ']':
      case 0x8f:
        return PushItems(Kind::kList, {}), true;
      case 'l':
      case 0x91:
        return PushItems(Kind::kList, PopMark()), true;
      case 'a': {
        PickleNodePtr item = Pop();
        return Append({std::move(item)}), true;
      }
      case 'e':
      case 0x90:
        return Append(PopMark()), true;
      case '}':
        return Push(context_.New(Kind::kDict)), true;
      case 'd': {
        PickleNodePtr dict = context_.New(Kind::kDict);
        SetItems(dict.get(), PopMark());
        return Push(std::move(dict)), true;
      }
      case 's': {
        PickleNodePtr value = Pop();
        PickleNodePtr key = Pop();
        return SetItems(&Top(), {std::move(key), std::move(value)}), true;
      }
      case 'u': {
        const std::vector<PickleNodePtr> items = PopMark();
        return SetItems(&Top(), items), true;
      }
      default:
        return false;
    }
  }

  // ---- memo and framing ----
  void Put(uint64_t key) {
    RequireAbove(1);
    context_.Charge(64);
    memo_[key] = stack_.back();
  }
  void Get(uint64_t key) {
    const auto it = memo_.find(key);
    if (it == memo_.end()) context_.Fail(Concatenate("memo entry ", key, " is used before it is set"));
    Push(it->second);
  }
  uint64_t LineKey() {
    const std::string_view line = TakeLine();
    uint64_t key = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), key);
    if (error != std::errc() || end != line.data() + line.size()) context_.Fail("expected the number of a memo entry");
    return key;
  }

  bool RunMemo(unsigned char opcode) {
    switch (opcode) {
      case 'p':
        return Put(LineKey()), true;
      case 'q':
        return Put(TakeUnsigned(1)), true;
      case 'r':
        return Put(TakeUnsigned(4)), true;
      case 0x94:
        return Put(memo_.size()), true;
      case 'g':
        return Get(LineKey()), true;
      case 'h':
        return Get(TakeUnsigned(1)), true;
      case 'j':
        return Get(TakeUnsigned(4)), true;
      case 0x80: {
        const uint64_t protocol = TakeUnsigned(1);
        if (protocol > kHighestProtocol) {
          context_.Fail(Concatenate("pickle protocol ", protocol, ", expected 0 to ", kHighestProtocol));
        }
        return true;
      }
      case 0x95: {
        const uint64_t length = TakeUnsigned(8);
        if (length > in_.size() - at_) {
          context_.Fail(Concatenate("a frame of ", length, " bytes, the file holds ", in_.size() - at_));
        }
        return true;
      }
      default:
        return false;
    }
  }

  // ---- objects ----
  void PushGlobal(std::string_view module, std::string_view name) {
    const std::string full = std::string(module) + "." + std::string(name);
    const PickleGlobal global = FindPickleGlobal(context_.dialect(), full);
    if (global == PickleGlobal::kNone) {
      context_.Fail("the pickle names '" + PrintableText(full) +
                    "', which is not on the list of plain data types; the file is refused and nothing was executed" +
                    Advice(module));
    }
    PickleNodePtr node = context_.New(Kind::kObject);
    node->global = global;
    node->is_callable = true;
    node->text = full;
    Push(std::move(node));
  }
  [[nodiscard]] const char* Advice(std::string_view module) const {
    if (context_.dialect() == PickleDialect::kTorch) return " (save the model's state_dict() alone)";
    return module.substr(0, 6) == "joblib" ? " (files of joblib before 0.10 are not read; save it again)" : "";
  }
  /// torch.save refers to its storages by these; the id is a tuple.
  void PushPersistentId() {
    const PickleNodePtr id = Pop();
    if (id->kind != Kind::kTuple) context_.Fail("a persistent id that is not a tuple");
    context_.Charge(id->items.size() * kSlot);
    PickleNodePtr node = context_.New(Kind::kObject);
    node->text = kPicklePersistentId;
    node->items = id->items;
    Push(std::move(node));
  }
  void Call(const PickleNode& callable, const PickleNode& args) { Push(CallPickleGlobal(&context_, callable, args)); }
  PickleNodePtr TupleOf(std::vector<PickleNodePtr> items) {
    PushItems(Kind::kTuple, std::move(items));
    return Pop();
  }

  bool RunObject(unsigned char opcode) {
    switch (opcode) {
      case 'c': {
        const std::string_view module = TakeLine();
        return PushGlobal(module, TakeLine()), true;
      }
      case 0x93: {
        const PickleNodePtr name = Pop(), module = Pop();
        if (name->kind != Kind::kString || module->kind != Kind::kString) context_.Fail("expected a module and a name");
        return PushGlobal(module->Text(), name->Text()), true;
      }
      case 'R':
      case 0x81: {
        const PickleNodePtr args = Pop(), callable = Pop();
        return Call(*callable, *args), true;
      }
      case 0x92: {
        const PickleNodePtr keywords = Pop(), args = Pop(), callable = Pop();
        if (keywords->kind != Kind::kDict || !keywords->dict.empty()) context_.Fail("keyword arguments are not read");
        return Call(*callable, *args), true;
      }
      case 'i': {
        const std::string_view module = TakeLine();
        PushGlobal(module, TakeLine());
        const PickleNodePtr callable = Pop();
        const PickleNodePtr args = TupleOf(PopMark());
        return Call(*callable, *args), true;
      }
      case 'o': {
        std::vector<PickleNodePtr> items = PopMark();
        if (items.empty()) context_.Fail("expected a class");
        const PickleNodePtr callable = items.front();
        items.erase(items.begin());
        const PickleNodePtr args = TupleOf(std::move(items));
        return Call(*callable, *args), true;
      }
      case 'Q':
        if (context_.dialect() != PickleDialect::kTorch) return false;
        return PushPersistentId(), true;
      case 'b': {
        const PickleNodePtr state = Pop();
        SetPickleState(&context_, &Top(), state);
        if (Top().global == PickleGlobal::kJoblibArray) at_ += TakeJoblibArray(&context_, &Top(), in_.substr(at_));
        return true;
      }
      default:
        return false;
    }
  }

  [[noreturn]] void ThrowFileError(unsigned char opcode) const {
    const char* meaning = opcode == 'P' || opcode == 'Q'     ? " (a persistent id)"
                          : opcode >= 0x82 && opcode <= 0x84 ? " (an extension code)"
                          : opcode == 0x97 || opcode == 0x98 ? " (a buffer outside the file)"
                                                             : "";
    context_.Fail(Concatenate("opcode ", static_cast<int>(opcode), meaning, ", expected plain data of a pickle"));
  }

  std::string_view in_;
  PickleContext& context_;
  size_t at_;
  std::vector<PickleNodePtr> stack_;
  std::vector<size_t> marks_;
  std::unordered_map<uint64_t, PickleNodePtr> memo_;
  PickleNodePtr none_, true_, false_;
};

}  // namespace

PickleNodePtr RunPickle(std::string_view bytes, PickleContext* context) { return PickleMachine(bytes, context).Run(); }

}  // namespace bodyloom
