// The words of the command line, and from them its completion for bash, zsh and fish.
#include "command_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "cli.h"
#include "core/error.h"
#include "edit/command_lines.h"
#include "exit.h"
#include "scene/describe.h"

namespace astrosplat {
namespace {

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

}  // namespace

std::vector<CommandWords> command_words(const CLI::App& app) {
    std::vector<CommandWords> commands{words_of_app(app, "")};
    for (const CLI::App* command : app.get_subcommands({}))
        commands.push_back(words_of_app(*command, command->get_name()));
    return commands;
}

namespace {

// Completion.

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

/// Keys that --set takes as they stand: those of layers need a layer's name, for which the scripts ask the
/// program.
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

}  // namespace astrosplat
