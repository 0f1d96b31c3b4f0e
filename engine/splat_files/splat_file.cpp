// The front door: one table of endings, readers and writers.
#include "splat_files/splat_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "core/error.h"
#include "splat_files/native.h"
#include "splat_files/pda.h"
#include "splat_files/ply.h"

namespace astrosplat {

namespace {

struct FileFormat {
    std::string_view ending;
    SplatSet (*read)(const std::filesystem::path&, const Progress&);
    void (*write)(const std::filesystem::path&, const SplatSet&, const Progress&);
};

constexpr std::array<FileFormat, 3> formats = {{
    {".pda", read_pda, write_pda},
    {".ply", read_ply, write_ply},
    {".splats", read_native, write_native},
}};

const FileFormat* find_format(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const auto* const found =
        std::find_if(formats.begin(), formats.end(), [&](const FileFormat& f) { return f.ending == ending; });
    return found == formats.end() ? nullptr : found;
}

const FileFormat& format_of(const std::filesystem::path& file) {
    if (const FileFormat* format = find_format(file)) return *format;
    const std::string ending = file.extension().string();
    bad_input(file.string(), "", "the ending .pda, .ply or .splats", ending.empty() ? "none" : ending);
}

}  // namespace

bool is_splat_file(const std::filesystem::path& file) { return find_format(file) != nullptr; }

SplatSet read_splats(const std::filesystem::path& file, const Progress& progress) {
    return format_of(file).read(file, progress);
}

void write_splats(const std::filesystem::path& file, const SplatSet& set, const Progress& progress) {
    format_of(file).write(file, set, progress);
}

}  // namespace astrosplat
