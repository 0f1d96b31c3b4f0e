// Which files hold stars. In: a file of any kind. Out: whether a reader of this folder would take it.
#pragma once

#include <filesystem>

namespace astrosplat {

enum class CatalogueKind {
    none,
    sky,     // catalogue.h reads it
    picture  // picture_table.h does
};

/// By its first line, whatever its name. Of gzip data only where it begins as such; none for what cannot be
/// read. Throws InputError for damaged gzip data.
CatalogueKind kind_of_catalogue(const std::filesystem::path& file);

}  // namespace astrosplat
