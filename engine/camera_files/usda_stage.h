// The text of USD (.usda) as a tree of prims, of which only what places a camera is kept. In: the text. Out:
// prims with their transforms and lenses; all else is passed by. No file that it refers to is opened.
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
};

struct UsdPrim {
    std::string type, name;
    bool defined = true;                             // def; else over or class, which alone make nothing
    std::map<std::string, UsdAttribute> attributes;  // xformOp:..., xformOpOrder and those of a camera's lens
    std::vector<UsdPrim> children;
};

struct UsdStage {
    std::map<std::string, UsdValue> metadata;  // upAxis, timeCodesPerSecond, ...
    std::vector<UsdPrim> prims;
    bool refers_elsewhere = false;  // to layers, references or payloads
};

/// Throws InputError with `file` and the line.
UsdStage parse_usda(std::string_view text, const std::string& file);

}  // namespace astrosplat
