#include "scenarios/action.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/model/effects.h"

namespace insonate {
namespace {

struct KindOfAction {
  ActionKind kind;
  const char* word;
  std::size_t numbers;
  bool has_text;
};
constexpr std::array kKinds{
    KindOfAction{ActionKind::probe, "probe", 0, true},
    KindOfAction{ActionKind::depth, "depth", 1, false},
    KindOfAction{ActionKind::frequency, "frequency", 1, false},
    KindOfAction{ActionKind::gain, "gain", 1, false},
    KindOfAction{ActionKind::dynamic_range, "dynamic_range", 1, false},
    KindOfAction{ActionKind::time_gain, "time_gain", 2, false},
    KindOfAction{ActionKind::compounding, "compounding", 1, false},
    KindOfAction{ActionKind::persistence, "persistence", 1, false},
    KindOfAction{ActionKind::edge_enhancement, "edge_enhancement", 1, false},
    KindOfAction{ActionKind::speckle_reduction, "speckle_reduction", 1, false},
    KindOfAction{ActionKind::effect, "effect", 1, true},
    KindOfAction{ActionKind::freeze, "freeze", 0, false},
    KindOfAction{ActionKind::unfreeze, "unfreeze", 0, false},
    KindOfAction{ActionKind::caliper, "caliper", 5, false},
    KindOfAction{ActionKind::ellipse, "ellipse", 6, false},
    KindOfAction{ActionKind::point, "point", 2, false},
    KindOfAction{ActionKind::label, "label", 2, true},
    KindOfAction{ActionKind::take_back, "take_back", 1, true},
    KindOfAction{ActionKind::answer, "answer", 0, true},
    KindOfAction{ActionKind::hint, "hint", 0, false},
    KindOfAction{ActionKind::go_to, "go_to", 0, true},
    KindOfAction{ActionKind::go_on, "go_on", 0, false},
    KindOfAction{ActionKind::guide, "guide", 1, false},
    KindOfAction{ActionKind::patient, "patient", 0, true},
};
constexpr bool in_order_of_enumeration() {
  for (std::size_t i = 0; i < kKinds.size(); ++i)
    if (std::size_t(kKinds[i].kind) != i) return false;
  return true;
}
static_assert(in_order_of_enumeration());
constexpr std::string_view kHex = "0123456789ABCDEF";

bool is_plain(char c) {
  return c > ' ' && c < 0x7f && c != '%' && c != ';';
}

void append_escaped(std::string& to, std::string_view text) {
  for (const char c : text.substr(0, Action::kLongestText)) {
    if (is_plain(c)) {
      to += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      (to += '%').append({kHex[byte >> 4], kHex[byte & 15]});
    }
  }
}

/// Returns the parts of a text between separators, trimmed of blanks, without empty parts.
std::vector<std::string_view> parts(std::string_view text, char separator) {
  std::vector<std::string_view> found;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    std::string_view part = text.substr(0, end);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
    if (!part.empty()) found.push_back(part);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return found;
}

class ActionReader {
public:
  ActionReader(const std::string& file, const std::string& place) : file_(file), place_(place) {}

  Action read(std::string_view text) const {
    const std::vector<std::string_view> words = parts(text, ' ');
    const KindOfAction& kind = kind_of(words.front());
    const std::size_t wanted = 1 + kind.numbers + kind.has_text;
    if (words.size() != wanted)
      refuse("the action '" + std::string(kind.word) + "' is followed by " + std::to_string(words.size() - 1) +
             " words instead of " + std::to_string(wanted - 1));
    Action action{kind.kind};
    for (std::size_t i = 0; i < kind.numbers; ++i) action.numbers[i] = number(words[1 + i]);
    const bool takes_back = kind.kind == ActionKind::take_back;
    const bool has_slot = takes_back || kind.kind == ActionKind::caliper || kind.kind == ActionKind::ellipse;
    if (has_slot) check_whole(action, "a slot", takes_back ? 0 : 1, Action::kMaxSlots);
    if (kind.kind == ActionKind::guide) check_whole(action, "a guide", 0, 1);
    if (kind.kind == ActionKind::time_gain) check_whole(action, "a slider", 1, Action::kTimeGainSliders);
    if (kind.has_text && words.back().front() != ':') refuse("an action's text does not begin with ':'");
    if (kind.has_text) action.text = unescaped(words.back().substr(1));
    if (kind.kind == ActionKind::effect) check_effect(action);
    return action;
  }

private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy = "record the scan again") const {
    throw InputError(file_, place_, problem, remedy);
  }

  void check_whole(const Action& action, const std::string& what, int least, int most) const {
    const double number = action.numbers[0];
    if (!(number >= least && number <= most && number == action.slot()))
      refuse(what + " is not a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  }

  void check_effect(const Action& action) const {
    if (action.text.empty()) return;
    const Effect* effect = find_effect(action.text);
    if (!effect) {
      std::vector<std::string> known;
      for (const Effect& each : effects()) known.emplace_back(each.name);
      std::string shown;
      append_escaped(shown, std::string_view(action.text).substr(0, 40));
      refuse("there is no effect '" + shown + "'", suggest(action.text, known));
    }
    const double value = action.numbers[0];
    if (!(value >= effect->least && value <= effect->most) || (effect->whole && value != std::floor(value)))
      refuse("the effect '" + action.text + "' has a value that is not a " + (effect->whole ? "whole " : "") +
             "number from " + exact_text(effect->least) + " to " + exact_text(effect->most));
  }

  const KindOfAction& kind_of(std::string_view word) const {
    std::vector<std::string> known;
    for (const KindOfAction& kind : kKinds) {
      if (word == kind.word) return kind;
      known.emplace_back(kind.word);
    }
    std::string shown;
    append_escaped(shown, word.substr(0, 40));
    refuse("there is no action '" + shown + "'", suggest(word, known));
  }

  double number(std::string_view word) const {
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !(std::abs(value) <= Action::kLargestNumber))
      refuse("an action has a value that is not a number from -1,000,000 to 1,000,000");
    return value;
  }

  std::string unescaped(std::string_view word) const {
    std::string text;
    for (std::size_t i = 0; i < word.size(); ++i) {
      if (word[i] != '%') {
        text += word[i];
        continue;
      }
      const std::size_t high = i + 2 < word.size() ? kHex.find(word[i + 1]) : std::string_view::npos;
      const std::size_t low = i + 2 < word.size() ? kHex.find(word[i + 2]) : std::string_view::npos;
      if (high == std::string_view::npos || low == std::string_view::npos)
        refuse("an action's text has a '%' without two hexadecimal digits behind it");
      text += char(high * 16 + low);
      i += 2;
    }
    if (text.size() > Action::kLongestText)
      refuse("an action's text has more than " + std::to_string(Action::kLongestText) + " bytes");
    return text;
  }

  const std::string& file_;
  const std::string& place_;
};

}  // namespace

std::string_view word_of(ActionKind kind) {
  return kKinds[std::size_t(kind)].word;
}

std::string to_text(std::span<const Action> actions) {
  std::string text;
  for (const Action& action : actions) {
    const KindOfAction& kind = kKinds[std::size_t(action.kind)];
    if (!text.empty()) text += "; ";
    text += kind.word;
    for (std::size_t i = 0; i < kind.numbers; ++i) {
      char digits[32];
      text.append(" ").append(digits, std::to_chars(digits, digits + sizeof digits, action.numbers[i]).ptr);
    }
    if (kind.has_text) append_escaped(text += " :", action.text);
  }
  return text;
}

std::vector<Action> parse_actions(std::string_view text, const std::string& file, const std::string& place) {
  const ActionReader reader(file, place);
  std::vector<Action> actions;
  for (const std::string_view part : parts(text, ';')) actions.push_back(reader.read(part));
  return actions;
}

std::map<double, std::string> to_texts(const ActionLog& log) {
  std::map<double, std::string> texts;
  for (const auto& [time_s, actions] : log) texts.emplace(time_s, to_text(actions));
  return texts;
}

ActionLog parse_action_log(const std::map<double, std::string>& texts, const std::string& file) {
  ActionLog log;
  for (const auto& [time_s, text] : texts) {
    char place[48];
    std::snprintf(place, sizeof place, "actions at %.4f s", time_s);
    log.emplace(time_s, parse_actions(text, file, place));
  }
  return log;
}

}  // namespace insonate
