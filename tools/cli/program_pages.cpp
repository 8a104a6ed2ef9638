#include "tools/cli/program_pages.h"

#include <algorithm>
#include <cctype>
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

/// Returns the type of the value, "FOLDER" or "TEXT", without its conditions, which CLI11 appends after a colon. The
/// type "[ADDRESS:]PORT" contains a colon of its own.
std::string kind_of_value(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::size_t colon = type.find(':');
  while (colon + 1 < type.size() && type[colon + 1] == ']') colon = type.find(':', colon + 1);
  return type.substr(0, colon);
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

/// Returns a list entry for an option or an argument, with its limits and default after its description.
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
  std::vector<std::string> more;
  if (const std::string range = range_of(option); !range.empty()) more.push_back(range);
  if (!option.get_default_str().empty()) more.push_back("default: " + option.get_default_str());
  return more.empty() ? roff : roff + as_is("(" + joined(more, "; ") + ")") + "\n";
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
         ".TP\n2\nThe input cannot be used, or the output cannot be written. One sentence on standard error says which "
         "and what to do.\n.TP\n3\nAnother failure, such as too little memory or no OpenGL 4.5.\n";
}

constexpr const char* kEnvironment =
    ".SH ENVIRONMENT\n"
    ".TP\nINSONATE_ASSETS\nThe folder of the bundled assets, instead of the installed one.\n"
    ".TP\nINSONATE_EGL_DEVICE\nThe number of the EGL device to draw with where there is no window.\n"
    ".TP\nLIBGL_ALWAYS_SOFTWARE\nMesa draws on the processor if this is 1.\n"
    ".TP\nXDG_CACHE_HOME\nThe built\\-in patient is kept in its folder insonate, or in \\(ti/.cache/insonate.\n";

std::string see_also(const std::string& program) {
  std::vector<std::string> others;
  for (const std::string& other : split(INSONATE_INSTALLED_PROGRAMS, ' '))
    if (other != program) others.push_back(bold(other) + "(1)");
  return ".SH SEE ALSO\n" + joined(others, ",\n") + "\n";
}

// The completion.

/// Returns the completion of an option's value, as a statement of the script. A plain `return` lets bash complete
/// files.
std::string completion_of_value(const CLI::Option& option) {
  const std::vector<std::string> choices = choices_of(option);
  if (!choices.empty()) return "words='" + joined(choices, " ") + "'";
  const std::string kind = kind_of_value(option);
  if (kind == "FOLDER") return "compopt +o default -o dirnames; return";
  for (const char* file : {"FILE", "PATH", "LOG", "TEXT", "URI"})
    if (kind == file) return "return";
  return "compopt +o default; return";
}

void add_completion(const CLI::App& app, std::string& script) {
  const std::string name = full_name(app);
  const std::string path = name.find(' ') == std::string::npos ? "" : name.substr(name.find(' '));
  std::vector<std::string> all, commands;
  script += "    '" + path + "')\n      case $previous in\n";
  for (const CLI::Option* option : options_of(app)) {
    const std::vector<std::string> names = names_of(*option);
    all.insert(all.end(), names.begin(), names.end());
    if (takes_value(*option))
      script += "        " + joined(names, " | ") + ") " + completion_of_value(*option) + " ;;\n";
  }
  for (const CLI::App* command : commands_of(app)) commands.push_back(command->get_name());
  script += "        *) [[ $current == -* ]] && words='" + joined(all, " ") + "' || words='" + joined(commands, " ") +
            "' ;;\n      esac ;;\n";
  for (const CLI::App* command : commands_of(app)) add_completion(*command, script);
}

void add_paths(const CLI::App& app, std::vector<std::string>& paths) {
  for (const CLI::App* command : commands_of(app)) {
    const std::string name = full_name(*command);
    paths.push_back("'" + name.substr(name.find(' ')) + "'");
    add_paths(*command, paths);
  }
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
  std::string function = "_" + name;
  std::replace(function.begin(), function.end(), '-', '_');
  std::vector<std::string> paths;
  add_paths(program, paths);
  std::string script = "# The completion of " + name + " for bash, made from its list of options.\n" + function +
                       "() {\n"
                       "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
                       "  local command='' words='' word\n"
                       "  # bash makes words of their own of the = in --name=value.\n"
                       "  if [[ $current == '=' ]]; then\n"
                       "    current=''\n"
                       "  elif [[ $previous == '=' ]]; then\n"
                       "    previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
                       "  fi\n";
  if (!paths.empty())
    script += "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n    case \"$command $word\" in\n      " +
              joined(paths, " | ") + ") command+=\" $word\" ;;\n    esac\n  done\n";
  script += "  COMPREPLY=()\n  case $command in\n";
  add_completion(program, script);
  return script +
         "  esac\n  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n}\ncomplete -o default -F " +
         function + " " + name;
}

}  // namespace insonate
