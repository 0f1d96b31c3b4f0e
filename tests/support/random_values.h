// Hashed numbers, the same in every run, and values that a described parameter may have.
#pragma once

#include "core/shared_maths.h"
#include "scene/parameter.h"

namespace astrosplat::test {

class Numbers {
  public:
    explicit Numbers(std::uint32_t seed) : seed_(seed) {}
    std::uint32_t next() { return shared::as_hash(seed_, count_++, 0u, 1u); }
    std::size_t below(std::size_t n) { return next() % n; }
    double frame() { return double(1 + below(48)); }
    double between(double lo, double hi) { return lo + (hi - lo) * (next() / 4294967296.0); }

  private:
    std::uint32_t seed_, count_ = 0;
};

inline double random_number(const ParameterSpec& spec, Numbers& numbers) {
    const double x =
        numbers.between(std::fmax(spec.min, spec.slider_min), std::fmin(spec.max, spec.slider_max));
    return spec.type == ParameterType::integer ? std::floor(x) : x;
}

inline Value random_list(const ParameterSpec& spec, Numbers& numbers) {
    const bool whole = spec.generic_key == "output.resolution" || spec.generic_key == "layer.source.voxels";
    Value::List list;
    for (int i = 0; i < spec.components; ++i) {
        const double x = random_number(spec, numbers);
        if (whole)
            list.emplace_back(std::int64_t(x));
        else
            list.emplace_back(x);
    }
    return list;
}

inline Value random_words(const ParameterSpec& spec, Numbers& numbers) {
    Value::List words;
    for (const std::string& choice : spec.choices)
        if (numbers.below(2) == 1) words.emplace_back(choice);
    return words;
}

inline std::string random_text(const ParameterSpec& spec, Numbers& numbers) {
    if (!spec.choices.empty()) return spec.choices[numbers.below(spec.choices.size())];
    if (spec.generic_key == "output.frames") return "1-" + std::to_string(2 + numbers.below(90)) + "x3";
    if (spec.generic_key == "layer.name") return "layer_" + std::to_string(numbers.below(1000000));
    return "Größe \"x\\y\" #" + std::to_string(numbers.below(100));
}

/// Within the slider's range; files are names of files that need not be there.
inline Value random_value(const ParameterSpec& spec, Numbers& numbers) {
    const std::string file = "ordner ü/bild " + std::to_string(numbers.below(100)) + ".png";
    switch (spec.type) {
        case ParameterType::boolean:
            return numbers.below(2) == 1;
        case ParameterType::integer:
            return std::int64_t(random_number(spec, numbers));
        case ParameterType::number:
            return random_number(spec, numbers);
        case ParameterType::text:
            return random_text(spec, numbers);
        case ParameterType::choice:
            return spec.choices[numbers.below(spec.choices.size())];
        case ParameterType::words:
            return random_words(spec, numbers);
        case ParameterType::file:
            if (spec.generic_key == "output.preset") return "dome";
            return spec.generic_key == "layer.preset" ? "vorlage.toml" : file;
        case ParameterType::files:
            if (numbers.below(2) == 1) return file;
            return Value::List{file, "b.png", "c ä.png"};
        case ParameterType::pattern:
            return "bilder " + std::to_string(numbers.below(100)) + "/b.####.png";
        case ParameterType::curve:
            return Value::List{Value::List{0.0, numbers.between(0, 1)},
                               Value::List{numbers.between(0.1, 0.9), numbers.between(0, 1)},
                               Value::List{1.0, numbers.between(0, 1)}};
        default:
            return random_list(spec, numbers);
    }
}

}  // namespace astrosplat::test
