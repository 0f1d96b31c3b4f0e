// The text of USD (.usda) as a tree of prims, of which only what places cameras and Gaussians is kept, and
// where each prim stands at a time. In: the text. Out: prims with their transforms, lenses and Gaussians'
// lists; all else is passed by. No file that it refers to is opened.
#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <set>

#include "core/standard.h"

namespace astrosplat {

/// Tuples and lists in one row.
struct UsdValue {
    std::vector<double> numbers;
    std::vector<std::string> words;  // strings and tokens

    bool is(std::string_view word) const { return words.size() == 1 && words[0] == word; }
};

struct UsdAttribute {
    bool has_value = false;
    UsdValue value;
    std::vector<std::pair<double, UsdValue>> samples;  // ascending time codes
    std::string_view list;  // [...] of Gaussians, which may be long: unread, in the text that was given
};

inline constexpr std::string_view usd_gaussians = "ParticleField3DGaussianSplat";  // of UsdVol 26.03

struct UsdPrim {
    std::string type, name;
    bool defined = true;                             // def; else over or class, which alone make nothing
    std::map<std::string, UsdAttribute> attributes;  // as usda_stage.cpp has them
    std::map<std::string, std::string> variants;     // that are selected, by their sets
    std::vector<std::string> unread;                 // what it has and nothing follows: references, fStop
    std::vector<UsdPrim> children;                   // those of selected variants among them

    /// An empty one where it has none of the name.
    const UsdAttribute& attribute(const std::string& name) const;
};

struct UsdStage {
    std::map<std::string, UsdValue> metadata;  // upAxis, timeCodesPerSecond, ...
    std::vector<UsdPrim> prims;
    bool refers_elsewhere = false;  // to layers, references or payloads
    bool has_unselected = false;    // variants of which none is selected

    bool is_z_up() const;
    /// For a message: what was found where nothing was.
    std::string none_found() const;
};

/// `text` outlives what its lists are read from. Throws InputError with `file` and the line.
UsdStage parse_usda(std::string_view text, const std::string& file);

/// "references of 'NAME', fStop of 'LAST' are not followed", of a prim and its parents; empty where all is.
std::string left_out(std::span<const UsdPrim* const> prims);

// Where a prim stands at a time: matrices and numbers, between samples as USD has them.

/// An attribute's numbers at a time code: held before its first sample and after its last, linear between
/// neighbours of as many numbers, else held. `fallback` where it has neither value nor samples.
std::vector<double> numbers_at(const UsdPrim& prim, const std::string& name, double time,
                               std::vector<double> fallback);

/// From the last prim's space to the world: each prim is a child of the one before. Column vectors. Throws
/// InputError with `file` where an operation is unknown or has too few numbers.
glm::dmat4 world_from_prim(std::span<const UsdPrim* const> prims, double time, const std::string& file);

/// Adds the time codes at which anything that moves the prim or its lens has a sample.
void add_times(const UsdPrim& prim, std::set<double>& times);

}  // namespace astrosplat
