#include "tools/cli/program_pages.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

namespace insonate {
namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
  return text;
}

// The information that CLI11 has on a program. Help omits everything in the group "", and so do these pages.

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* o) { return !o->get_positional() && !o->get_group().empty(); });
}

std::vector<const CLI::Option*> positionals_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* o) { return o->get_positional() && !o->get_group().empty(); });
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

/// Returns the name of the value, "FOLDER" or "NUMBER", without its conditions, which CLI11 appends after a colon. The
/// name "[ADDRESS:]PORT" contains a colon of its own.
std::string kind_of_value(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::size_t colon = type.find(':');
  while (colon + 1 < type.size() && type[colon + 1] == ']') colon = type.find(':', colon + 1);
  const std::string kind = type.substr(0, colon);
  return kind == "INT" || kind == "UINT" || kind == "FLOAT" ? "NUMBER" : kind;
}

/// Returns the permitted values of the option if they are a few words.
std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find(":{"), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return split(type.substr(open + 2, close - open - 2), ',');
}

/// Returns the limits, such as "10 to 400", or an empty text if the option has none.
std::string range_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find(" in ["), middle = type.find(" - "), close = type.find(']');
  if (open == std::string::npos || middle == std::string::npos || close == std::string::npos) return "";
  return type.substr(open + 5, middle - open - 5) + " to " + type.substr(middle + 3, close - middle - 3);
}

std::string names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());  // the set is in the order of addresses
  return joined(names, ", ");
}

/// Returns the conditions of a value, such as "(10 to 400; default: 70)", or an empty text if there are none.
std::string conditions_of(const CLI::Option& option) {
  std::vector<std::string> conditions;
  if (option.get_positional() && !choices_of(option).empty()) conditions.push_back(joined(choices_of(option), ", "));
  if (const std::string range = range_of(option); !range.empty()) conditions.push_back(range);
  if (option.get_required() && !option.get_positional()) conditions.push_back("required");
  if (!option.get_required() && !option.get_default_str().empty())
    conditions.push_back("default: " + option.get_default_str());
  if (!option.get_needs().empty()) conditions.push_back("needs " + names_of(option.get_needs()));
  if (!option.get_excludes().empty()) conditions.push_back("not with " + names_of(option.get_excludes()));
  return conditions.empty() ? "" : "(" + joined(conditions, "; ") + ")";
}

/// Returns the full name of a command, such as "insonate-case inspect".
std::string full_name(const CLI::App& app) {
  return (app.get_parent() ? full_name(*app.get_parent()) + " " : "") + app.get_name();
}

// The man page.

/// Returns text that roff prints literally. Its minus is the character that is typed in options.
std::string as_is(std::string_view text) {
  std::string roff;
  for (const char c : text) {
    const bool line_begins = roff.empty() || roff.back() == '\n';
    if (line_begins && (c == '.' || c == '\'')) roff += "\\&";
    switch (c) {
      case '\\':
        roff += "\\e";
        break;
      case '-':
        roff += "\\-";
        break;
      case '\'':
        roff += "\\(aq";
        break;
      case '`':
        roff += "\\(ga";
        break;
      case '~':
        roff += "\\(ti";
        break;
      case '^':
        roff += "\\(ha";
        break;
      default:
        roff += c;
    }
  }
  return roff;
}

std::string bold(const std::string& text) {
  return "\\fB" + as_is(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + as_is(text) + "\\fR";
}

std::size_t indent_of(const std::string& line) {
  return std::min(line.find_first_not_of(' '), line.size());
}

/// Formats the prose of a help text. An empty line begins a paragraph. An indented block is a list: its least indented
/// lines are the items, and the lines below them describe an item.
std::string prose(const std::string& text) {
  std::string roff;
  std::size_t of_list = 0;
  const auto end_list = [&] {
    if (of_list > 0) roff += ".RE\n";
    of_list = 0;
  };
  for (const std::string& line : split(text, '\n')) {
    const std::size_t indent = indent_of(line);
    const std::string words = line.substr(indent);
    if (words.empty()) {
      end_list();
      roff += ".PP\n";
    } else if (indent == 0) {
      end_list();
      roff += as_is(words) + "\n";
    } else {
      if (of_list == 0) {
        roff += ".RS\n";
        of_list = indent;
      }
      roff += indent == of_list ? ".TP 4\n" + bold(words) + "\n" : as_is(words) + "\n";
    }
  }
  end_list();
  return roff;
}

std::string value_of(const CLI::Option& option) {
  if (!takes_value(option)) return "";
  const std::vector<std::string> choices = choices_of(option);
  if (choices.empty()) return " " + italic(kind_of_value(option));
  std::string text;
  for (const std::string& choice : choices) text += (text.empty() ? " " : "|") + bold(choice);
  return text;
}

/// Returns a list entry for an option or an argument, with its conditions after its description.
std::string entry(const CLI::Option& option) {
  std::string roff = ".TP\n";
  if (option.get_positional()) {
    roff += italic(option.get_name(true));
  } else {
    std::vector<std::string> names;
    for (const std::string& name : names_of(option)) names.push_back(bold(name));
    roff += joined(names, ", ") + value_of(option);
  }
  roff += "\n" + prose(option.get_description());
  const std::string conditions = conditions_of(option);
  return conditions.empty() ? roff : roff + as_is(conditions) + "\n";
}

std::string entries(const CLI::App& app) {
  std::string roff;
  for (const CLI::Option* positional : positionals_of(app)) roff += entry(*positional);
  for (const CLI::Option* option : options_of(app)) {
    if (app.get_parent() && option == app.get_help_ptr()) continue;  // every command has it
    roff += entry(*option);
  }
  return roff;
}

/// Returns one line for the program or command itself, followed by those of its commands.
std::string synopsis(const CLI::App& app) {
  std::string roff;
  if (app.get_require_subcommand_min() == 0) {
    roff += bold(full_name(app)) + " [" + italic("OPTION") + "]...";
    for (const CLI::Option* option : options_of(app))
      if (option->get_required()) roff += " " + bold(names_of(*option).back()) + value_of(*option);
    for (const CLI::Option* positional : positionals_of(app)) {
      std::string word = italic(positional->get_name(true));
      if (positional->get_items_expected_max() > 1) word += "...";
      roff += positional->get_required() ? " " + word : " [" + word + "]";
    }
    roff += "\n.br\n";
  }
  for (const CLI::App* command : commands_of(app)) roff += synopsis(*command);
  return roff;
}

/// Formats the footer of a help text: examples become a section, or part of a command's section.
std::string footer(const CLI::App& app) {
  constexpr std::string_view kExamples = "Examples:\n";
  std::string text = app.get_footer(), roff;
  if (app.get_parent() && text == app.get_parent()->get_footer()) return "";  // commands inherit it in CLI11
  if (text.starts_with(kExamples)) {
    text = text.substr(kExamples.size());
    roff += app.get_parent() ? ".PP\nExamples:\n.EX\n" : ".SH EXAMPLES\n.EX\n";
    std::string rest;
    bool examples = true;
    for (const std::string& line : split(text, '\n')) {
      examples = examples && indent_of(line) > 0 && !line.empty();
      (examples ? roff : rest) += examples ? as_is(line.substr(2)) + "\n" : line + "\n";
    }
    roff += ".EE\n";
    text = rest;
  }
  // For the program, the section EXIT STATUS contains it.
  if (!app.get_parent()) text = text.substr(0, text.find("Exit codes:"));
  if (text.find_first_not_of('\n') == std::string::npos) return roff;
  return roff + ".PP\n" + prose(text.substr(text.find_first_not_of('\n')));
}

std::string command_sections(const CLI::App& app) {
  std::string roff;
  for (const CLI::App* command : commands_of(app)) {
    if (command->get_require_subcommand_min() == 0) {
      const std::string name = full_name(*command);
      roff += ".SS " + as_is(name.substr(name.find(' ') + 1)) + "\n" + prose(command->get_description()) +
              entries(*command) + footer(*command);
    }
    roff += command_sections(*command);
  }
  return roff;
}

/// Splits a description into the NAME line, without its full stop, and the rest.
std::pair<std::string, std::string> name_and_rest(const std::string& description) {
  const std::size_t stop = std::min(description.find('.'), description.size());
  std::string name = description.substr(0, stop);
  std::replace(name.begin(), name.end(), '\n', ' ');
  const bool is_abbreviation = name.size() > 1 && std::isupper(static_cast<unsigned char>(name[1])) != 0;
  if (!name.empty() && !is_abbreviation) name[0] = char(std::tolower(static_cast<unsigned char>(name[0])));
  const std::size_t rest = description.find_first_not_of(". \n", stop);
  return {name, rest == std::string::npos ? "" : description.substr(rest)};
}

std::string exit_status(bool has_commands) {
  std::string roff = ".SH EXIT STATUS\n.TP\n0\nThe work is done.\n";
  if (has_commands)
    roff +=
        ".TP\n1\nThe work is done, and a check or a comparison found something to look at. Only commands that check or "
        "compare return it.\n";
  return roff +
         ".TP\n2\nThe input cannot be used, or the output cannot be written. One sentence on standard error names "
         "the input and what to do.\n.TP\n3\nAnother failure, such as too little memory or no OpenGL 4.5.\n";
}

constexpr const char* kEnvironment =
    ".SH ENVIRONMENT\n"
    ".TP\nINSONATE_ASSETS\nThe folder of the bundled assets, instead of the installed one.\n"
    ".TP\nINSONATE_EGL_DEVICE\nThe number of the EGL device to draw with where there is no window.\n"
    ".TP\nLIBGL_ALWAYS_SOFTWARE\nMesa draws on the processor if this is 1.\n"
    ".TP\nXDG_CACHE_HOME\nThe built\\-in patient is kept in its folder insonate, or in \\(ti/.cache/insonate.\n";

std::string see_also(const std::string& program) {
  std::vector<std::string> others;
  for (const std::string& other : split(INSONATE_PROGRAM_NAMES, ' '))
    if (other != program) others.push_back(bold(other) + "(1)");
  return ".SH SEE ALSO\n" + joined(others, ",\n") + "\n";
}

// The completion.

/// Returns the completion of a value as a statement of the script.
std::string completion_of_value(const CLI::Option& option) {
  const std::vector<std::string> choices = choices_of(option);
  if (!choices.empty()) return "words='" + joined(choices, " ") + "'";
  const std::string kind = kind_of_value(option);
  if (kind == "FOLDER") return "compopt -o dirnames";
  // A URI such as replay:FILE ends in a file. bash completes the part after the colon.
  if (kind == "FILE" || kind == "PATH" || kind == "URI") return "compopt -o default";
  return ":";
}

/// Adds the branches of the script that complete the command and its own commands, and collects the names that the
/// script looks for in a line, each behind its command.
void add_completion(const CLI::App& app, std::string& branches, std::vector<std::string>& options,
                    std::vector<std::string>& commands) {
  const std::string name = full_name(app);
  const std::string path = name.find(' ') == std::string::npos ? "" : name.substr(name.find(' '));
  std::vector<std::string> all, own_commands;
  for (const CLI::Option* option : options_of(app)) {
    std::vector<std::string> before_value;
    for (const std::string& written : names_of(*option)) {
      all.push_back(written);
      if (!takes_value(*option)) continue;
      options.push_back("'" + path + " " + written + "'");
      before_value.push_back("'" + path + " " + written + "='");
    }
    if (!before_value.empty())
      branches += "    " + joined(before_value, " | ") + ") " + completion_of_value(*option) + " ;;\n";
  }
  for (const CLI::App* command : commands_of(app)) {
    own_commands.push_back(command->get_name());
    commands.push_back("'" + path + " " + command->get_name() + "'");
  }
  branches += "    '" + path + " -'*) words='" + joined(all, " ") + "' ;;\n";
  const std::vector<const CLI::Option*> positionals = positionals_of(app);
  if (!own_commands.empty())
    branches += "    '" + path + " ') words='" + joined(own_commands, " ") + "' ;;\n";
  else if (!positionals.empty())
    branches += "    '" + path + " ') " + completion_of_value(*positionals.front()) + " ;;\n";
  for (const CLI::App* command : commands_of(app)) add_completion(*command, branches, options, commands);
}

}  // namespace

std::string man_page(const CLI::App& program) {
  const std::string& name = program.get_name();
  std::string title = name;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  const auto [summary, rest] = name_and_rest(program.get_description());
  const std::string commands = command_sections(program);
  std::string roff = ".TH " + as_is(title) + " 1 \"\" \"Insonate " INSONATE_VERSION "\" \"Insonate\"\n.SH NAME\n" +
                     as_is(name) + " \\- " + as_is(summary) + "\n.SH SYNOPSIS\n" + synopsis(program);
  if (!rest.empty()) roff += ".SH DESCRIPTION\n" + prose(rest);
  roff += ".SH OPTIONS\n" + entries(program);
  if (!commands.empty()) roff += ".SH COMMANDS\n" + commands;
  return roff + footer(program) + exit_status(!commands.empty()) + kEnvironment + see_also(name);
}

std::string bash_completion(const CLI::App& program) {
  const std::string& name = program.get_name();
  std::string function = "_" + name, branches;
  std::replace(function.begin(), function.end(), '-', '_');
  std::vector<std::string> options, commands;
  add_completion(program, branches, options, commands);
  std::string script = "# The completion of " + name + " for bash, made from its list of options.\n" + function +
                       R"(() {
  local current=${COMP_WORDS[COMP_CWORD]} command='' option='' last='' joint='' words='' word
  # `option` is the option whose value comes next. bash makes separate words of = and :, as in --name=value and
  # hydra:SERIAL. What follows them belongs to the same value, that of `last`.
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word == [=:] ]]; then
      option=$last joint=$word
      continue
    fi
    [[ $joint == : && $word == -* ]] && option=''
    joint=''
    if [[ $option ]]; then
      last=$option option=''
      continue
    fi
    last=''
    case "$command $word" in
      )" + joined(options, " | ") +
                       ") option=$word last=$word ;;\n";
  if (!commands.empty()) script += "      " + joined(commands, " | ") + ") command+=\" $word\" ;;\n";
  return script + R"(    esac
  done
  if [[ $current == [=:] ]]; then
    option=$last current=''
  elif [[ $joint == : && ${COMP_LINE:0:COMP_POINT} != *:"$current" ]]; then
    option=''  # a space follows the colon
  fi
  word=''
  if [[ $option ]]; then
    word=$option=
  elif [[ $current == -* ]]; then
    word=$current
  fi
  COMPREPLY=()
  case "$command $word" in
)" + branches +
         "  esac\n  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n}\ncomplete -F " + function + " " +
         name;
}

namespace {

/// Breaks the text's lines at spaces, at most `width` characters long. A line's indentation is kept.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string all;
  for (std::string line : split(text, '\n')) {
    const std::string indent(indent_of(line), ' ');
    while (line.size() > width) {
      const std::size_t space = line.rfind(' ', width);
      if (space == std::string::npos || space <= indent.size()) break;
      all += line.substr(0, space) + "\n";
      line = indent + line.substr(space + 1);
    }
    all += line + "\n";
  }
  if (!all.empty()) all.pop_back();
  return all;
}

constexpr std::size_t kHelpWidth = 100, kHelpColumn = 30;

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_positional() || !takes_value(*option)) return "";
  const std::vector<std::string> choices = choices_of(*option);
  return " " + (choices.empty() ? kind_of_value(*option) : joined(choices, "|"));
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::string& text = option->get_description();
  const std::string conditions = conditions_of(*option);
  const bool ends_in_list = text.find("\n ") != std::string::npos;
  return wrapped(text + (conditions.empty() ? "" : (ends_in_list ? "\n" : " ") + conditions), kHelpWidth - kHelpColumn);
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return wrapped(app->get_description(), kHelpWidth) + "\n";
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  std::ostringstream line;
  CLI::detail::format_help(line, command->get_name(), wrapped(command->get_description(), kHelpWidth - kHelpColumn),
                           kHelpColumn);
  return line.str();
}

}  // namespace insonate
