// The readers and writers of each format, and the choice among them by a file's format.
#include "splat_files/splat_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"
#include "core/file_format.h"
#include "core/log.h"
#include "core/text.h"
#include "splat_files/formats.h"
#include "splat_files/native.h"
#include "usd/usda_stage.h"

namespace astrosplat {
namespace {

struct Functions {
    std::string_view format;
    SplatSet (*read)(const fs::path&, const Progress&);
    void (*write)(const WriteTarget&, const SplatSet&, const Progress&);
    SplatColumns (*columns)(const fs::path&);
    std::int64_t (*count)(const fs::path&);
    std::string_view word;   // that files with splats have near their beginning; empty: all hold splats
    bool keeps_all = false;  // splats that absorb are kept apart from those that shine; shapes of Gaussians
};

constexpr Functions functions[] = {
    {"pda", read_pda, write_pda, pda_columns, pda_splat_count, ""},
    {"ply", read_ply, write_ply, ply_columns, ply_splat_count, ""},
    {"gltf", read_gltf_splats, nullptr, gltf_splat_columns, nullptr, gltf_gaussians},
    {"usda", read_usda_splats, nullptr, usda_splat_columns, usda_splat_count, usd_gaussians},
    {"spz", read_spz, nullptr, spz_columns, spz_splat_count, ""},
    {"splat", read_dot_splat, nullptr, dot_splat_columns, dot_splat_splat_count, ""},
    {"sog", read_sog, nullptr, sog_columns, sog_splat_count, ""},
    {"splats", [](const auto& file, const auto& progress) { return read_native(file, progress); },
     [](const auto& file, const auto& set, const auto& progress) { write_native(file, set, progress); },
     native_columns, native_splat_count, "", true},
};

const Functions& functions_of(const FileFormat* format, const fs::path& file, FileUse use = FileUse::read) {
    for (const Functions& each : functions)
        if (format && format->id == each.format && (use == FileUse::read || each.write)) return each;
    const std::string ending = file.extension().string();
    bad_input(file, fmt::format("one of the endings {}", fmt::join(endings_of({FileKind::splats}, use), " ")),
              (ending.empty() ? "none" : ending) + std::string(conversion_advice(file)));
}

}  // namespace

SplatSet read_splats(const fs::path& file, const Progress& progress) {
    require_readable(file);
    return functions_of(format_of_file(file), file).read(file, progress);
}

std::vector<std::string> splat_attributes(const fs::path& file) {
    require_readable(file);
    return column_names(functions_of(format_of_file(file), file).columns(file));
}

std::int64_t splat_count(const fs::path& file) {
    require_readable(file);
    const Functions& functions = functions_of(format_of_file(file), file);
    assert(functions.count);
    return functions.count(file);
}

bool may_hold_splats(const fs::path& file) {
    const FileFormat* const format = format_of_file(file);
    if (kind_of(format) != FileKind::splats) return false;
    constexpr std::size_t beginning = std::size_t{1} << 20;
    const std::string_view word = functions_of(format, file).word;
    const std::string text = word.empty() ? "" : read_beginning(file, beginning);
    return text.empty() || text.find(word) != std::string::npos;
}

void write_splats(const WriteTarget& target, const SplatSet& set, const Progress& progress) {
    const Functions& functions = functions_of(format_by_name(target.file), target.file, FileUse::written);
    const auto dust = std::ranges::count_if(set.color, [](const glm::vec3& c) { return c.x < 0.0f; });
    if (holds_gaussians(set) && !functions.keeps_all)
        log_warning(fmt::format(
            "{}: this format has no room for the shapes and the colours by direction of Gaussians: "
            "they become round; .splats keeps them, and export writes them",
            target.file.string()));
    if (set.absorbs && dust > 0 && !functions.keeps_all)
        log_warning(
            fmt::format("{}: the dust, {}, absorbs light, which this format cannot say: it becomes grey; "
                        ".splats keeps it",
                        target.file.string(), counted(dust, "splat")));
    functions.write(target, set, progress);
}

}  // namespace astrosplat
