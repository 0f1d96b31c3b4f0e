#include "command_words.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cctype>

namespace astrosplat {
namespace {

OptionWords words_of(const CLI::Option& option) {
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

CommandWords words_of(const CLI::App& app, const std::string& name) {
    CommandWords words{name, app.get_description(), {}, {}};
    for (const CLI::Option* option : app.get_options()) {
        OptionWords own = words_of(*option);
        (own.names.empty() ? words.positionals : words.options).push_back(std::move(own));
    }
    return words;
}

}  // namespace

bool OptionWords::is_file() const {
    constexpr std::array starts{"SCENE",  "FILE", "IMAGE",   "IN",     "OUT",
                                "FOLDER", "DIR",  "PATTERN", "REPORT", "FRAME"};
    const auto end = std::find_if(placeholder.begin(), placeholder.end(),
                                  [](unsigned char c) { return !std::isupper(c); });
    const std::string word(placeholder.begin(), end);
    return std::find(starts.begin(), starts.end(), word) != starts.end() ||
           (names.empty() && word.size() == 1);  // A and B of compare
}

bool OptionWords::is_assignment() const { return placeholder == "KEY=VALUE"; }

std::vector<std::string> OptionWords::choices() const {
    const bool lists = placeholder.find('|') != std::string::npos &&
                       std::all_of(placeholder.begin(), placeholder.end(),
                                   [](unsigned char c) { return std::islower(c) || c == '|'; });
    std::vector<std::string> words;
    if (!lists) return words;
    std::size_t begin = 0;
    for (std::size_t end; (end = placeholder.find('|', begin)) != std::string::npos; begin = end + 1)
        words.push_back(placeholder.substr(begin, end - begin));
    words.push_back(placeholder.substr(begin));
    return words;
}

std::vector<CommandWords> command_words(const CLI::App& app) {
    std::vector<CommandWords> commands{words_of(app, "")};
    for (const CLI::App* command : app.get_subcommands({}))
        commands.push_back(words_of(*command, command->get_name()));
    return commands;
}

}  // namespace astrosplat
