#include "scene/preset_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file.h"
#include "core/folders.h"
#include "scene/entries.h"

namespace astrosplat {
namespace fs = std::filesystem;

void check_version(const toml::table& table, const std::string& file, bool required) {
    const toml::node* node = table.get("astrosplat");
    if (!node && !required) return;
    if (!node)
        throw InputError(fmt::format("{}: expected a scene that begins with 'astrosplat = 1', found {}", file,
                                     table.empty() ? "an empty file" : "no such line"));
    const std::string place = place_of(file, node->source());
    if (!node->is_integer())
        throw InputError(
            fmt::format("{}: astrosplat: expected the format version 1, found {}", place, kind_of(*node)));
    if (node->as_integer()->get() != 1)
        throw InputError(fmt::format("{}: astrosplat: expected the format version 1, found {}", place,
                                     node->as_integer()->get()));
}

PresetFile find_look(const fs::path& wanted) {
    std::error_code ignored;
    const fs::path file = find_by_name("looks", wanted), looks = assets_folder("looks");
    if (fs::exists(file, ignored) || looks.empty()) return {file, read_file(file)};
    throw InputError(
        fmt::format("{}: cannot be read: No such file or directory; the looks that come with astrosplat are "
                    "in {}, by name: {}",
                    file.string(), looks.string(), fmt::join(names_in("looks"), ", ")));
}

PresetFile find_output_preset(const fs::path& wanted) {
    std::error_code ignored;
    if (wanted.has_extension()) return {wanted, read_file(wanted)};
    const fs::path name = wanted.filename().string() + ".toml";
    for (const fs::path& place : {own_assets_folder("masters"), assets_folder("masters")})
        if (fs::is_regular_file(place / name, ignored)) return {place / name, read_file(place / name)};
    throw InputError(fmt::format("{}: no preset of the output has this name; known are: {}",
                                 wanted.filename().string(), fmt::join(names_in("masters"), ", ")));
}

void apply_preset(const PresetFile& preset, const std::function<Description()>& describe, Places& places) {
    const std::string file = preset.file.string();
    const toml::table root = parse_toml(preset.text, file);
    check_version(root, file, false);
    const EntryOrigin origin{file, preset.file.parent_path(), false, {}};
    std::vector<Entry> entries;
    for (const auto& [key, node] : root)
        if (key.str() != "astrosplat")
            flatten(node, std::string(key.str()), std::string(key.str()), origin, key.source(), entries);
    apply_entries(std::move(entries), origin, describe, places);
}

}  // namespace astrosplat
