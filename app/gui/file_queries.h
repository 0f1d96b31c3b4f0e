// Requests of the file dialog: titles, kinds and folders, by command or by parameter.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "edit/commands.h"
#include "edit/document.h"
#include "scene/parameter_key.h"

namespace astrosplat {

/// A file the person is to choose.
struct FileQuery {
    std::string title;                    // "Open a scene"
    bool saving = false;                  // the file need not exist, and is asked for again where it does
    std::string kind;                     // "Scenes", of the filter
    std::vector<std::string> extensions;  // ".toml", lower case; empty: any
    std::filesystem::path folder;         // to begin in
    std::string name;                     // suggested, when saving
    std::filesystem::path otherwise{};    // to begin in where there is no such folder; empty: home
};

/// The request where `kind` needs a path; nothing where it needs none.
std::optional<FileQuery> query_for(Command::Kind kind, const Document& document);
/// The request for the value of a parameter.
FileQuery query_for(const ParameterKey& key, const Document& document);

}  // namespace astrosplat
