// The text of USD (.usda) as a tree of prims, of which only what places cameras and Gaussians is kept. In:
// the text. Out: prims with their transforms, lenses and Gaussians' lists; all else is passed by. No file
// that it refers to is opened.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace astrosplat {

/// Tuples and lists in one row.
struct UsdValue {
    std::vector<double> numbers;
    std::vector<std::string> words;  // strings and tokens
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
    std::vector<UsdPrim> children;
};

struct UsdStage {
    std::map<std::string, UsdValue> metadata;  // upAxis, timeCodesPerSecond, ...
    std::vector<UsdPrim> prims;
    bool refers_elsewhere = false;  // to layers, references or payloads

    bool is_z_up() const;
    /// For a message: what was found where nothing was.
    std::string none_found() const;
};

/// `text` outlives what its lists are read from. Throws InputError with `file` and the line.
UsdStage parse_usda(std::string_view text, const std::string& file);

}  // namespace astrosplat
