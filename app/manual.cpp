// The manual pages as troff: texts of app/manual, with tables made from the command line and the parameters.
#include "command_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <sstream>
#include <string_view>

#include "cli.h"
#include "core/error.h"
#include "exit.h"
#include "scene/describe.h"
#include "scene/parameter.h"

namespace astrosplat {

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
