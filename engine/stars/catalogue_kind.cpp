#include "stars/catalogue_kind.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "stars/catalogue_text.h"
#include "stars/hipparcos.h"
#include "stars/picture_table.h"
#include "stars/text_table.h"

namespace astrosplat {
namespace {

constexpr std::size_t beginning_bytes = 8192;

std::string beginning_of(const std::filesystem::path& file) {
    const std::string bytes = read_beginning(file, beginning_bytes);
    return bytes.starts_with("\x1f\x8b") ? read_catalogue_text(file).substr(0, beginning_bytes) : bytes;
}

}  // namespace

CatalogueKind kind_of_catalogue(const std::filesystem::path& file) {
    const std::string text = beginning_of(file);
    if (text.find('\0') != text.npos) return CatalogueKind::none;
    TextLines lines(text);
    if (!lines.next()) return CatalogueKind::none;
    if (is_hipparcos(lines.line())) return CatalogueKind::sky;
    if (is_picture_table(lines.line())) return CatalogueKind::picture;
    const TextTable table(lines.line());
    const bool has_all = table.column({"ra"}) != TextTable::none &&
                         table.column({"dec"}) != TextTable::none &&
                         table.column({"mag", "vmag"}) != TextTable::none;
    return has_all ? CatalogueKind::sky : CatalogueKind::none;
}

}  // namespace astrosplat
