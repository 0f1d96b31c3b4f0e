// Some 300 much pictured objects of the sky: their names, kinds, sizes, angles and distances, one plain table
// among the assets. In: a name, or any text that may hold one. Out: the object.
#pragma once

#include "core/text.h"

namespace astrosplat {

enum class ObjectKind {
    spiral,
    barred,
    lenticular,
    elliptical,
    irregular,
    interacting,  // two or more galaxies that touch
    galaxy_group,
    galaxy_cluster,
    deep_field,
    open_cluster,
    globular_cluster,
    planetary,
    remnant,
    emission,
    reflection,
    dark,
    star,
    other
};
constexpr auto names_of(ObjectKind) {
    return names_up_to<ObjectKind::other>("spiral", "barred", "lenticular", "elliptical", "irregular",
                                          "interacting", "galaxy_group", "galaxy_cluster", "deep_field",
                                          "open_cluster", "globular_cluster", "planetary", "remnant",
                                          "emission", "reflection", "dark", "star", "other");
}

struct CatalogueObject {
    std::vector<std::string>
        names;  // the best known catalogue's first: "M 104", "NGC 4594", "Sombrero Galaxy"
    ObjectKind kind = ObjectKind::other;
    double right_ascension_deg = 0.0, declination_deg = 0.0;  // J2000
    std::optional<double> major_arcmin, minor_arcmin;  // whole axes, of galaxies at 25 mag / square second
    std::optional<double> position_angle_deg;          // of the major axis, from north through east
    std::optional<double> inclination_deg;             // of a galaxy's disk: 0 face-on, 90 edge-on
    std::optional<double> distance_ly;                 // light years
    std::string source;                                // where the figures are from
};

/// The rows of a table with the columns of assets/objects/objects.csv. `file` begins messages. Throws
/// InputError "FILE:LINE: expected ..." for a column that is missing, an unknown kind or a figure
/// that is none.
std::vector<CatalogueObject> parse_catalogue(std::string_view text, const std::string& file);

/// That of the assets, read once; empty, and said so, where they are not installed. Throws InputError where
/// it is damaged.
const std::vector<CatalogueObject>& object_catalogue();

/// The object with this name, as people write it: "M104", "messier 104", "NGC 0891", "Sh2-106", "sombrero
/// galaxy". Null: none has it.
const CatalogueObject* object_named(std::string_view name);

/// The object whose name stands first in a text such as a title or a file's name ("m101_final-v2"); of
/// several names at one place the longest. What is left after a name may follow in letters only where the
/// name ends in digits. Short words and single letters that mean other things as well ("C 14", "Ring") are
/// not searched for. Null: none.
const CatalogueObject* object_in(std::string_view text);

}  // namespace astrosplat
