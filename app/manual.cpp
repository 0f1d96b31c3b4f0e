// The command line as words, and from them its completion for bash, zsh and fish, and the manual pages as
// troff: texts of app/manual, with tables made from the command line and the parameters.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <map>
#include <regex>
#include <sstream>

#include "command.h"
#include "core/error.h"
#include "edit/command_lines.h"
#include "exit.h"
#include "scene/describe.h"
#include "scene/parameter.h"

namespace astrosplat {
namespace {

struct OptionWords {
    std::vector<std::string> names;  // "-o", "--output"; empty: a positional
    std::string placeholder;         // "auto|plain|none", "SCENE"; empty: a flag
    std::string help;
    bool repeats = false;  // a positional that takes several
};

struct CommandWords {
    std::string name;  // empty: the program's own options
    std::string help;
    std::vector<OptionWords> options;      // those with names
    std::vector<OptionWords> positionals;  // in their order
};

OptionWords option_words(const CLI::Option& option) {
    OptionWords words;
    for (const std::string& name : option.get_snames()) words.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) words.names.push_back("--" + name);
    if (option.get_expected_max() > 0)
        words.placeholder =
            option.get_option_text().empty() ? option.get_name(true) : option.get_option_text();
    words.help = option.get_description();
    words.repeats = option.get_expected_max() > 1;
    return words;
}

CommandWords words_of_app(const CLI::App& app, const std::string& name) {
    CommandWords words{name, app.get_description(), {}, {}};
    for (const CLI::Option* option : app.get_options()) {
        OptionWords own = option_words(*option);
        (own.names.empty() ? words.positionals : words.options).push_back(std::move(own));
    }
    return words;
}

/// The program's own words first, then those of its commands, as they stand in the help.
std::vector<CommandWords> command_words(const CLI::App& app) {
    std::vector<CommandWords> commands{words_of_app(app, "")};
    for (const CLI::App* command : app.get_subcommands({}))
        commands.push_back(words_of_app(*command, command->get_name()));
    return commands;
}

// Completion scripts for shells.

/// Its value is a file or a folder.
bool is_file(const OptionWords& option) {
    constexpr std::array starts{"SCENE",  "FILE", "IMAGE",   "IN",     "OUT",
                                "FOLDER", "DIR",  "PATTERN", "REPORT", "FRAME"};
    const std::string& placeholder = option.placeholder;
    const auto end = std::ranges::find_if(placeholder, [](unsigned char c) { return !std::isupper(c); });
    const std::string word(placeholder.begin(), end);
    return std::ranges::find(starts, word) != starts.end() ||
           (option.names.empty() && word.size() == 1);  // A and B of compare
}

bool is_assignment(const OptionWords& option) { return option.placeholder == "KEY=VALUE"; }

/// Of a placeholder such as "auto|plain|none"; else empty.
std::vector<std::string> choices_of(const OptionWords& option) {
    const std::string& placeholder = option.placeholder;
    const bool lists =
        placeholder.find('|') != std::string::npos &&
        std::ranges::all_of(placeholder, [](unsigned char c) { return std::islower(c) || c == '|'; });
    return lists ? split(placeholder, '|') : std::vector<std::string>();
}

using Words = std::vector<std::string>;

// In single quotes, for bash and zsh.
std::string quoted(const std::string& text) {
    std::string safe = "'";
    for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return safe + "'";
}

std::string quoted_for_fish(const std::string& text) { return "'" + with_backslashes(text, "'\\") + "'"; }

/// In descriptions of zsh's _arguments brackets and colons have a meaning.
std::string described_for_zsh(const std::string& text) { return with_backslashes(text, "[]:\\"); }

Words names_of(const CommandWords& command) {
    Words names;
    for (const OptionWords& option : command.options)
        names.insert(names.end(), option.names.begin(), option.names.end());
    return names;
}

Words command_names(const std::vector<CommandWords>& commands) {
    Words names;
    for (const CommandWords& command : commands)
        if (!command.name.empty()) names.push_back(command.name);
    return names;
}

// Completions of each option that takes a value: one line of a case over "COMMAND OPTION".
std::string bash_values(const CommandWords& command) {
    std::string text;
    for (const OptionWords& option : command.options) {
        if (option.placeholder.empty()) continue;
        Words patterns;
        for (const std::string& name : option.names) patterns.push_back(quoted(command.name + " " + name));
        const std::string reply = is_assignment(option) ? "keys"
                                  : is_file(option)     ? "files"
                                  : !choices_of(option).empty()
                                      ? fmt::format("words {}", fmt::join(choices_of(option), " "))
                                      : ":";
        text += fmt::format("        {}) {} ;;\n", fmt::join(patterns, "|"), reply);
    }
    return text;
}

std::string bash_script(const std::vector<CommandWords>& commands, const Words& keys) {
    std::string values, options;
    std::string places;  // of positionals
    for (const CommandWords& command : commands) {
        values += bash_values(command);
        for (const OptionWords& positional : command.positionals)
            if (!choices_of(positional).empty())
                places += fmt::format("            {}) words {} ;;\n", command.name,
                                      fmt::join(choices_of(positional), " "));
        options +=
            fmt::format("        {}) words {} ;;\n", quoted(command.name), fmt::join(names_of(command), " "));
    }
    Words assigned;
    for (const std::string& key : keys) assigned.push_back(quoted(key + "="));
    return fmt::format(R"(# bash completion of astrosplat
_astrosplat() {{
    local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command= word
    words() {{ mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -W "$*" -- "$cur"); }}
    files() {{
        compopt -o filenames 2>/dev/null
        mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -f -- "$cur")
    }}
    # Those of layers are known where a scene is named.
    keys() {{
        local scene of_layers=
        for scene in "${{COMP_WORDS[@]:1}}"; do
            case $scene in *.toml) of_layers=$("${{COMP_WORDS[0]}}" parameters --names "${{scene//\\/}}" 2>/dev/null) ;; esac
        done
        words {keys} $(printf '%s\n' "$of_layers" | sed -n 's/^layer\..*/&=/p')
        compopt -o nospace 2>/dev/null
    }}
    COMPREPLY=()
    for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
        case $word in {commands}) command=$word; break ;; esac
    done
    case "$command $prev" in
{values}        *) case $cur in
        -*) case $command in
{options}        esac ;;
        *)  [ -n "$command" ] || [ "$COMP_CWORD" != 1 ] || words {spaced}
            case $command in
{places}            *) files ;;
            esac ;;
        esac ;;
    esac
    unset -f words files keys
}}
complete -F _astrosplat astrosplat
)",
                       fmt::arg("keys", fmt::format("{}", fmt::join(assigned, " "))),
                       fmt::arg("commands", fmt::format("{}", fmt::join(command_names(commands), "|"))),
                       fmt::arg("spaced", fmt::format("{}", fmt::join(command_names(commands), " "))),
                       fmt::arg("values", values), fmt::arg("places", places), fmt::arg("options", options));
}

std::string zsh_arguments(const CommandWords& command) {
    std::string text;
    for (const OptionWords& option : command.options) {
        std::string value;
        if (is_assignment(option))
            value = ":key:_astrosplat_keys";
        else if (!choices_of(option).empty())
            value = fmt::format(":value:({})", fmt::join(choices_of(option), " "));
        else if (!option.placeholder.empty())
            value = ":" + described_for_zsh(option.placeholder) + ":" + (is_file(option) ? "_files" : "");
        for (const std::string& name : option.names)
            text += " \\\n            " + quoted((is_assignment(option) ? "*" : "") + name + "[" +
                                                 described_for_zsh(option.help) + "]" + value);
    }
    std::string place = "_files";
    for (const OptionWords& positional : command.positionals)
        if (!choices_of(positional).empty())
            place = fmt::format("({})", fmt::join(choices_of(positional), " "));
    return text + " \\\n            " + quoted("*:file:" + place);
}

std::string zsh_script(const std::vector<CommandWords>& commands, const Words& keys) {
    std::string list, cases;
    for (const CommandWords& command : commands) {
        if (command.name.empty()) continue;
        list += "\n        " + quoted(command.name + ":" + command.help);
        cases += fmt::format("        {})\n        _arguments{} ;;\n", command.name, zsh_arguments(command));
    }
    return fmt::format(R"zsh(#compdef astrosplat
# Those of layers are known where a scene is named.
_astrosplat_keys() {{
    local -a keys
    local scene
    keys=({keys}=)
    for scene in ${{(M)words:#*.toml}}; do
        keys+=(${{^${{(M)${{(f)"$(${{(Q)words[1]}} parameters --names ${{(Q)scene}} 2>/dev/null)"}}:#layer.*}}}}=)
    done
    compadd -S '' -a keys
}}
_astrosplat() {{
    local -a commands
    commands=({list}
    )
    if (( CURRENT == 2 )) && [[ $words[2] != -* ]]; then
        _describe -t commands command commands
        _files
        return
    fi
    case $words[2] in
{cases}        *)
        _arguments{own} ;;
    esac
}}
_astrosplat "$@"
)zsh",
                       fmt::arg("keys", fmt::format("{}", fmt::join(keys, "= "))), fmt::arg("list", list),
                       fmt::arg("cases", cases), fmt::arg("own", zsh_arguments(commands.front())));
}

// `condition` is when the option may be meant.
std::string fish_line(const std::string& condition, const OptionWords& option) {
    std::string line = "complete -c astrosplat -n " + quoted_for_fish(condition);
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (is_assignment(option))
        line += " -x -a '(__astrosplat_keys)'";
    else if (!choices_of(option).empty())
        line +=
            fmt::format(" -x -a {}", quoted_for_fish(fmt::format("{}", fmt::join(choices_of(option), " "))));
    else if (!option.placeholder.empty())
        line += is_file(option) ? " -r -F" : " -x";
    return line + " -d " + quoted_for_fish(option.help) + "\n";
}

std::string fish_script(const std::vector<CommandWords>& commands, const Words& keys) {
    std::string text = fmt::format(R"fish(# fish completion of astrosplat
# Keys of layers are known where a scene is named.
function __astrosplat_keys
    printf '%s=\n' {}
    set -l words (commandline -opc)
    for scene in (string match -- '*.toml' $words)
        $words[1] parameters --names $scene 2>/dev/null | string match -- 'layer.*' | string replace -r '$' '='
    end
end
)fish",
                                   fmt::join(keys, " "));
    for (const CommandWords& command : commands) {
        if (!command.name.empty())
            text += fmt::format("complete -c astrosplat -n __fish_use_subcommand -a {} -d {}\n", command.name,
                                quoted_for_fish(command.help));
        // Not __fish_use_subcommand: behind a scene the program's own options are still meant.
        const std::string meant = command.name.empty() ? fmt::format("not __fish_seen_subcommand_from {}",
                                                                     fmt::join(command_names(commands), " "))
                                                       : "__fish_seen_subcommand_from " + command.name;
        for (const OptionWords& option : command.options) text += fish_line(meant, option);
        for (const OptionWords& positional : command.positionals)
            if (!choices_of(positional).empty()) text += fish_line(meant, positional);
    }
    return text;
}

/// Keys that --set takes as they stand: those of layers need a layer's name, for which the scripts
/// ask the program.
Words keys_to_set() {
    Words keys;
    for (const ParameterRow& row : parameter_rows())
        if (!row.spec.key.is_below("layer")) keys.push_back(row.spec.key.text());
    return keys;
}

/// Throws InputError for a shell that is none of the three.
std::string completion_script(const std::string& shell, const std::vector<CommandWords>& commands) {
    if (shell == "bash") return bash_script(commands, keys_to_set());
    if (shell == "zsh") return zsh_script(commands, keys_to_set());
    if (shell == "fish") return fish_script(commands, keys_to_set());
    bad_input("completion", "", "bash, zsh or fish", "'" + shell + "'");
}

}  // namespace

void add_completion(CLI::App& app, Invocation& call) {
    const auto run = [&app](const CommandOptions& options) {
        fmt::print("{}", completion_script(options.input.string(), command_words(app)));
        return exit_done;
    };
    CLI::App& command =
        add_command(app, call, "completion", "Prints a script with which a shell completes commands", run);
    add_value(command, "SHELL", call.options.input, "bash|zsh|fish", "The shell")->required();
}

std::string manual_text(
    const std::string& name);  // a file of app/manual, which the build puts into the program

namespace {

// Text in which troff sees nothing but text. What is typed at a terminal keeps its hyphens and quotes.
std::string plain(const std::string& text) {
    static const std::map<char, std::string> escapes{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                     {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"},
                                                     {'"', "\\(dq"}};
    std::string escaped;
    for (const char c : text) escaped += escapes.contains(c) ? escapes.at(c) : std::string(1, c);
    return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string slanted(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

/// A paragraph of Markdown: code and strong words are bold, stressed ones slanted; links leave their words.
std::string prose(const std::string& text) {
    static const std::regex mark(R"(\*\*([^*]+)\*\*|`([^`]+)`|\*([^*]+)\*|\[([^\]]+)\]\([^)]*\))");
    std::string troff;
    auto done = text.cbegin();
    for (std::sregex_iterator it(text.begin(), text.end(), mark), none; it != none; ++it) {
        const std::smatch& found = *it;
        troff += plain({done, found[0].first});
        if (found[4].matched)
            troff += plain(found[4]);
        else
            troff += found[3].matched ? slanted(found[3]) : bold(found[1].str() + found[2].str());
        done = found[0].second;
    }
    return troff + plain({done, text.cend()});
}

enum class BlockKind { heading, paragraph, item, code };
struct Block {
    BlockKind kind;
    std::string text;  // of code with its lines, otherwise one line
};

/// How a line of a block begins in Markdown as app/manual uses it; a block goes on until an empty line.
struct LineForm {
    std::string_view prefix;
    BlockKind kind;
    bool always_new = false;  // ends the block before it
};
constexpr std::array line_forms{LineForm{"## ", BlockKind::heading, true}, LineForm{"    ", BlockKind::code},
                                LineForm{"- ", BlockKind::item, true}, LineForm{"  ", BlockKind::item},
                                LineForm{"", BlockKind::paragraph}};
constexpr LineForm fenced_form{"", BlockKind::code};

std::vector<Block> blocks_of(const std::string& markdown) {
    std::vector<Block> blocks;
    std::istringstream lines(markdown);
    bool fenced = false, open = false;  // between two ```; the last block goes on
    for (std::string line; std::getline(lines, line);) {
        const bool fence = line.starts_with("```");
        if (fence) fenced = !fenced;
        if (fence || (line.empty() && !fenced)) {
            open = false;
            continue;
        }
        const LineForm& form =
            fenced ? fenced_form : *std::ranges::find_if(line_forms, [&](const LineForm& any) {
                return line.starts_with(any.prefix);
            });
        const std::string text = line.substr(form.prefix.size());
        if (open && !form.always_new)
            blocks.back().text += (form.kind == BlockKind::code ? "\n" : " ") + text;
        else
            blocks.push_back({form.kind, text});
        open = form.kind != BlockKind::heading;
    }
    return blocks;
}

std::string code_lines(const std::string& text) {
    std::string troff = ".PP\n.RS 4\n.EX\n";
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) troff += plain(line) + "\n";
    return troff + ".EE\n.RE\n";
}

std::string heading(std::string words) {
    std::ranges::transform(words, words.begin(), [](char c) { return c >= 'a' && c <= 'z' ? c - 32 : c; });
    return ".SH " + plain(words) + "\n";
}

std::string troff(const Block& block) {
    switch (block.kind) {
        case BlockKind::heading:
            return heading(block.text);
        case BlockKind::paragraph:
            return ".PP\n" + prose(block.text) + "\n";
        case BlockKind::item:
            return ".IP \\(bu 2\n" + prose(block.text) + "\n";
        case BlockKind::code:
            return code_lines(block.text);
    }
    return {};
}

/// A text of app/manual from its first heading on; what stands before is for those who read it there.
std::string chapters(const char* file) {
    const std::vector<Block> blocks = blocks_of(manual_text(file));
    std::string text;
    for (auto block = std::ranges::find(blocks, BlockKind::heading, &Block::kind); block != blocks.end();
         ++block)
        text += troff(*block);
    return text;
}

std::string title(const char* name, int section, const char* what) {
    return fmt::format(".TH {0} {1} \"\" \"astrosplat {2}\" \"{3}\"\n", name, section, ASTROSPLAT_VERSION,
                       what);
}

std::string entry(const std::string& head, const std::string& body) {
    return fmt::format(".TP\n{}\n{}\n", head, body);
}

std::string option_entry(const OptionWords& option) {
    std::string head;
    for (const std::string& name : option.names) head += (head.empty() ? "" : ", ") + bold(name);
    if (!option.placeholder.empty()) head += (head.empty() ? "" : " ") + slanted(option.placeholder);
    return entry(head, plain(option.help) + ".");
}

std::string usage_line(const CommandWords& command) {
    std::string line = bold("astrosplat");
    if (!command.name.empty()) line += " " + bold(command.name);
    for (const OptionWords& positional : command.positionals)
        line += " " + slanted(positional.placeholder) + (positional.repeats ? "..." : "");
    return line + " [" + slanted("OPTION") + "]...";
}

std::string options_text(const CommandWords& command) {
    std::string text;
    for (const OptionWords& positional : command.positionals) text += option_entry(positional);
    for (const OptionWords& option : command.options) text += option_entry(option);
    return text;
}

std::string key_entry(const ParameterRow& row) {
    const ParameterSpec& spec = row.spec;
    return entry(bold(spec.key.text()) + plain(" = " + to_toml(row.value)),
                 plain(spec.help) + "\n" + plain(value_words(spec)));
}

std::string command_manual(const std::vector<CommandWords>& commands) {
    std::string text = title("ASTROSPLAT", 1, "User Commands");
    text +=
        ".SH NAME\nastrosplat \\- volumes of soft splats from telescope pictures and meshes\n.SH SYNOPSIS\n";
    for (const CommandWords& command : commands)
        text += (&command == &commands.front() ? "" : ".br\n") + usage_line(command) + "\n";
    text += ".SH DESCRIPTION\n" + plain(commands.front().help) +
            "\nWithout a command the scene is opened in a window, with\n" + bold("--batch") +
            "\nits frames are rendered without one.\n.SH OPTIONS\n" + options_text(commands.front());
    text += ".SH COMMANDS\n";
    for (const CommandWords& command : commands) {
        if (command.name.empty()) continue;
        text += ".SS " + usage_line(command) + "\n" + plain(command.help) + ".\n" + options_text(command);
    }
    text += chapters("astrosplat.md");
    text += ".SH EXIT STATUS\n" + entry(fmt::format("{}", exit_done), "Done.") +
            entry(fmt::format("{}", exit_own_fault), "A fault of the program itself.") +
            entry(fmt::format("{}", exit_not_started), "Bad input or usage; nothing was started.") +
            entry(fmt::format("{}", exit_some_failed),
                  "Some frames failed, or what was compared differs; the others are written.") +
            entry(fmt::format("{}", exit_not_writable), "The place for the results cannot be written.") +
            entry("130, 143", "Stopped by an interrupt or a termination; nothing half was left.");
    return text + ".SH SEE ALSO\n.BR astrosplat\\-scene (5)\n";
}

std::string scene_manual() {
    std::string text = title("ASTROSPLAT\\-SCENE", 5, "File Formats");
    text +=
        ".SH NAME\nastrosplat\\-scene \\- scene files of astrosplat\n.SH DESCRIPTION\n"
        "A scene is a TOML file that begins with\n.BR \"astrosplat = 1\" .\n"
        "The chapters say what one does with it;\n.B KEYS\nat the end lists all of its keys.\n" +
        chapters("astrosplat-scene.md") +
        ".SH KEYS\nKeys with their defaults. Those that begin with\n.B layer\n"
        "stand in tables\n.BR [[layer]] ,\none for every layer.\n";
    std::string group;
    for (const ParameterRow& row : parameter_rows()) {
        const std::string key = row.spec.key.text(), own = key.substr(0, key.rfind('.'));
        if (own != group) text += ".SS " + plain(own) + "\n";
        group = own;
        text += key_entry(row);
    }
    return text + ".SH SEE ALSO\n.BR astrosplat (1)\n";
}

}  // namespace

void add_manual(CLI::App& app, Invocation& call) {
    const auto run = [&app](const CommandOptions& options) {
        const std::string section = options.input.string();
        if (section != "1" && section != "5") bad_input("manual", "", "1 or 5", "'" + section + "'");
        fmt::print("{}", section == "1" ? command_manual(command_words(app)) : scene_manual());
        return exit_done;
    };
    CLI::App& command =
        add_command(app, call, "manual", "Prints a manual page: 1 of the program, 5 of scene files", run);
    add_input(command, call.options, "SECTION", "1: the program, 5: scene files");
}

}  // namespace astrosplat
