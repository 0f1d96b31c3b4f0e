// The command line as words, for the manual page and the shells' completion. In: the one description that
// also parses (cli.h). Out: plain names and texts.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace astrosplat {

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

/// The program's own words first, then those of its commands, as they stand in the help.
std::vector<CommandWords> command_words(const CLI::App& app);

}  // namespace astrosplat
