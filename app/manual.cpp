#include "manual.h"

#include <fmt/format.h>

#include "exit_code.h"
#include "scene/describe.h"
#include "scene/value.h"

namespace astrosplat {
namespace {

// Text in which troff sees nothing but text. What is typed at a terminal keeps its hyphens and quotes.
std::string plain(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '\\':
                escaped += "\\e";
                break;
            case '-':
                escaped += "\\-";
                break;
            case '\'':
                escaped += "\\(aq";
                break;
            case '`':
                escaped += "\\(ga";
                break;
            case '^':
                escaped += "\\(ha";
                break;
            case '~':
                escaped += "\\(ti";
                break;
            case '"':
                escaped += "\\(dq";
                break;
            default:
                escaped += c;
        }
    }
    return escaped.starts_with('.') ? "\\&" + escaped : escaped;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string slanted(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

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

}  // namespace

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
    text += ".SH EXIT STATUS\n" + entry(fmt::format("{}", exit_done), "Done.") +
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
        "These are its keys with their defaults. Keys that begin with\n.B layer\n"
        "stand in tables\n.BR [[layer]] ,\none for every layer.\n";
    std::string group;
    for (const ParameterRow& row : parameter_rows()) {
        const std::string key = row.spec.key.text(), own = key.substr(0, key.rfind('.'));
        if (own != group) text += ".SH " + plain(own) + "\n";
        group = own;
        text += key_entry(row);
    }
    return text + ".SH SEE ALSO\n.BR astrosplat (1)\n";
}

}  // namespace astrosplat
