// The object that a picture shows. In: what its file, its name and a person say of it, and its light. Out:
// how sure one may be of each kind of object, and because of what.
#pragma once

#include <glm/vec2.hpp>

#include "core/image.h"
#include "objects/catalogue.h"
#include "objects/impression.h"
#include "source/object_metadata.h"
#include "source/source.h"

namespace astrosplat {

/// Clues to a picture's object that need no look at it.
struct ObjectClues {
    ObjectMetadata metadata;
    std::string file_name;                   // without folder and ending
    const CatalogueObject* named = nullptr;  // by a person (--object)
};

/// Of a picture's file: its metadata, as XMP or FITS has them, and its name. Throws InputError where it
/// cannot be read.
ObjectClues clues_of(const fs::path& picture);

struct ObjectGuess {
    SkyObject object = SkyObject::nebula;
    double sure = 0.0;  // 0..1
};

struct Identification {
    std::vector<ObjectGuess> guesses;                // the likeliest first; at least one; together at most 1
    StructureKind structure = StructureKind::sheet;  // of the first
    std::string why;                                 // of the first: "AVM says C.5.1.1: spiral galaxy"
    glm::dvec2 middle{0.5};                          // of what it shows, in shares of width and height
    ObjectMetadata metadata;                         // the picture's
    const CatalogueObject* known = nullptr;          // the object in the catalogue, where it has it
    std::optional<double> distance_ly;               // by metadata, else by the catalogue
};

/// The object as far as it is known before its light is looked at: metadata, known, distance_ly.
Identification said_of(const ObjectClues& clues);

/// Puts what is said and what is seen together: AVM's categories, the catalogue's entry of a name in the
/// metadata or the file's name, words of the title and file's name, and the light are taken for independent
/// witnesses, each with the share of pictures of which it is right (Bayes' rule, no kind likelier than
/// another beforehand). `light`: RGB, linear, >= 0.
/// `as`: what a person says that it is, which needs no reason.
Identification identify(const ObjectClues& clues, const Image& light, std::optional<SkyObject> as = {});

/// How long a pixel of a picture of this size is at the object's distance, where the picture's file tells its
/// scale and the distance is known: an arc, so that it holds for large angles as well.
std::optional<double> light_years_per_px(const Identification& found, double width_px, double height_px);

/// The kinds that a category of AVM means, by its taxonomy ("C.5.1.4": an elliptical galaxy); none for
/// instruments, people and the like.
std::vector<SkyObject> objects_of_category(std::string_view category);
/// "spiral galaxy"; empty where it means none of them.
std::string words_of_category(std::string_view category);

}  // namespace astrosplat
