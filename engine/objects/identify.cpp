#include "objects/identify.h"

#include <fmt/format.h>

#include <iterator>

#include "core/real.h"
#include "core/text.h"
#include "objects/impression.h"
#include "source/fits.h"

namespace astrosplat {
namespace {

using SkyObjects = std::vector<SkyObject>;

bool has(const SkyObjects& objects, SkyObject object) {
    return std::ranges::find(objects, object) != objects.end();
}

// How often such a witness is right. None was counted but the light (impression): observatories' categories
// and the table are wrong where a picture shows more than its object, titles also where they speak of where
// it lies.
constexpr double by_person = 0.999, by_category = 0.97, by_catalogue = 0.97, by_words = 0.85;
// The light: of pictures that the model was not made of, where nothing else speaks, and along with
// other witnesses.
constexpr double by_light_alone = 0.95, by_light = 0.81;

struct Category {
    const char* numbers;  // of the taxonomy, without the letter of the place in the universe
    const char* meaning;
    SkyObjects objects;
};

// AVM 1.2, appendix A, from the most special to the most general. Pictures of stars show what surrounds them
// as often.
const std::vector<Category>& taxonomy() {
    using enum SkyObject;
    static const std::vector<Category> categories{{"3.6.4.2", "globular cluster", {cluster}},
                                                  {"3.6.4.1", "open cluster", {field}},
                                                  {"3.6.4", "star cluster", {cluster, field}},
                                                  {"3.7", "matter around a star", {nebula, thin}},
                                                  {"4.1.3", "planetary nebula", {planetary}},
                                                  {"4.1.4", "supernova remnant", {remnant}},
                                                  {"5.1.1", "spiral galaxy", {galaxy}},
                                                  {"5.1.2", "barred galaxy", {galaxy}},
                                                  {"5.1.3", "lenticular galaxy", {galaxy}},
                                                  {"5.1.4", "elliptical galaxy", {elliptical}},
                                                  {"5.1.5", "ring galaxy", {galaxy}},
                                                  {"5.1.6", "irregular galaxy", {galaxy}},
                                                  {"5.1.7", "interacting galaxies", {galaxy}},
                                                  {"5.5.3", "cluster of galaxies", {field}},
                                                  {"5.5.4", "supercluster of galaxies", {field}},
                                                  {"1", "planet", {thin}},
                                                  {"2", "body between the planets", {thin}},
                                                  {"3", "star", {thin, nebula, field}},
                                                  {"4", "nebula", {nebula}},
                                                  {"5", "galaxy", {galaxy, elliptical}},
                                                  {"6", "deep field", {field}}};
    return categories;
}

const Category* find_category(std::string_view category) {
    const std::size_t begin = std::min(category.find_first_of("0123456789"), category.size());
    const std::string numbers = std::string(category.substr(begin)) + '.';
    const auto found = std::ranges::find_if(taxonomy(), [&](const Category& known) {
        return numbers.starts_with(std::string(known.numbers) + '.');
    });
    return found == taxonomy().end() ? nullptr : &*found;
}

SkyObjects objects_of(ObjectKind kind) {
    using enum SkyObject;
    switch (kind) {
        case ObjectKind::elliptical:
            return {elliptical};
        case ObjectKind::spiral:
        case ObjectKind::barred:
        case ObjectKind::lenticular:
        case ObjectKind::irregular:
        case ObjectKind::interacting:
            return {galaxy};
        case ObjectKind::galaxy_group:
            return {galaxy, field};
        case ObjectKind::galaxy_cluster:
        case ObjectKind::deep_field:
        case ObjectKind::open_cluster:
            return {field};
        case ObjectKind::globular_cluster:
            return {cluster};
        case ObjectKind::planetary:
            return {planetary};
        case ObjectKind::remnant:
            return {remnant};
        case ObjectKind::star:
            return {thin, nebula, field};
        default:
            return {nebula};
    }
}

struct Words {
    std::string_view words;
    SkyObject object;
};
// From the most special to the most general.
constexpr Words telling_words[] = {{"planetary nebula", SkyObject::planetary},
                                   {"supernova remnant", SkyObject::remnant},
                                   {"globular cluster", SkyObject::cluster},
                                   {"elliptical galaxy", SkyObject::elliptical},
                                   {"galaxy cluster", SkyObject::field},
                                   {"cluster of galaxies", SkyObject::field},
                                   {"open cluster", SkyObject::field},
                                   {"star cluster", SkyObject::field},
                                   {"deep field", SkyObject::field},
                                   {"light echo", SkyObject::nebula},
                                   {"star forming region", SkyObject::nebula},
                                   {"comet", SkyObject::thin},
                                   {"galaxy", SkyObject::galaxy},
                                   {"galaxies", SkyObject::galaxy},
                                   {"nebula", SkyObject::nebula}};

// Letters and digits in lower case between single blanks, one at either end as well.
std::string words_of(std::string_view text) {
    std::string words = " ";
    for (const char c : lower_case(std::string(text))) {
        const bool part = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (part) words += c;
        if (!part && words.back() != ' ') words += ' ';
    }
    return words.back() == ' ' ? words : words + ' ';
}

const Words* find_words(std::string_view text) {
    const std::string words = words_of(text);
    const auto found = std::ranges::find_if(telling_words, [&](const Words& telling) {
        return words.find(fmt::format(" {} ", telling.words)) != std::string::npos;
    });
    return found == std::end(telling_words) ? nullptr : &*found;
}

// One that says what a picture shows; it says nothing where it names no object.
struct Witness {
    SkyObjects objects;
    double right = 0.0;  // how often it is
    std::string why;
};

Witness by_categories(const std::vector<std::string>& categories) {
    Witness witness{{}, by_category, ""};
    for (const std::string& category : categories) {
        const Category* const known = find_category(category);
        if (!known) continue;
        for (const SkyObject object : known->objects)
            if (!has(witness.objects, object)) witness.objects.push_back(object);
        witness.why +=
            fmt::format("{} {}: {}", witness.why.empty() ? "AVM says" : ";", category, known->meaning);
    }
    return witness;
}

Witness by_table(const CatalogueObject* known, double right) {
    if (!known) return {};
    return {objects_of(known->kind), right,
            fmt::format("{} in the table of objects is {}", known->names.front(), name_of(known->kind))};
}

Witness by_text(const std::string& text) {
    const Words* const telling = find_words(text);
    if (!telling) return {};
    return {{telling->object}, by_words, fmt::format("'{}' says {}", printable(text), telling->words)};
}

// The first of metadata and file name that the catalogue has.
const CatalogueObject* known_object(const ObjectClues& clues) {
    if (clues.named) return clues.named;
    for (const std::string& name : clues.metadata.names)
        if (const CatalogueObject* known = object_in(name)) return known;
    const CatalogueObject* by_title = object_in(clues.metadata.title);
    return by_title ? by_title : object_in(clues.file_name);
}

// The witnesses together, the kinds that have less than a hundredth left out.
std::vector<ObjectGuess> weighed(const std::vector<Witness>& witnesses, const Likeness& seen) {
    const bool alone = std::ranges::all_of(witnesses, [](const Witness& w) { return w.objects.empty(); });
    const double light = alone ? by_light_alone : by_light;
    std::vector<ObjectGuess> guesses;
    double sum = 0.0;
    for (std::size_t k = 0; k < sky_object_count; ++k) {
        ObjectGuess guess{static_cast<SkyObject>(k),
                          light * seen.share[k] + (1.0 - light) / sky_object_count};
        for (const Witness& witness : witnesses) {
            if (witness.objects.empty()) continue;
            const auto named = static_cast<double>(witness.objects.size());
            const double others = static_cast<double>(sky_object_count) - named;
            guess.sure *=
                has(witness.objects, guess.object) ? witness.right / named : (1.0 - witness.right) / others;
        }
        sum += guess.sure;
        guesses.push_back(guess);
    }
    for (ObjectGuess& guess : guesses) guess.sure /= sum;
    std::ranges::stable_sort(guesses, std::ranges::greater(), &ObjectGuess::sure);
    std::erase_if(guesses, [](const ObjectGuess& guess) { return guess.sure < 0.01; });
    return guesses;
}

}  // namespace

ObjectClues clues_of(const std::filesystem::path& picture) {
    return {is_fits(picture) ? read_fits_metadata(picture) : read_xmp_metadata(picture),
            picture.stem().string()};
}

std::vector<SkyObject> objects_of_category(std::string_view category) {
    const Category* const known = find_category(category);
    return known ? known->objects : SkyObjects{};
}

std::string words_of_category(std::string_view category) {
    const Category* const known = find_category(category);
    return known ? known->meaning : "";
}

Identification said_of(const ObjectClues& clues) {
    Identification found;
    found.metadata = clues.metadata;
    found.known = known_object(clues);
    found.distance_ly = clues.metadata.distance_ly;
    if (!found.distance_ly && found.known) found.distance_ly = found.known->distance_ly;
    return found;
}

Identification identify(const ObjectClues& clues, const Image& light, std::optional<SkyObject> as) {
    const ObjectMetadata& metadata = clues.metadata;
    Identification found = said_of(clues);
    const Impression impression = impression_of(light);
    found.middle = impression.middle;
    if (as) {
        found.guesses = {{*as, 1.0}};
        found.structure = structure_of(*as, impression);
        return found;
    }
    const Likeness seen = likeness_of(impression);
    const std::vector<Witness> witnesses{by_table(clues.named, by_person), by_categories(metadata.categories),
                                         clues.named ? Witness{} : by_table(found.known, by_catalogue),
                                         by_text(metadata.title), by_text(clues.file_name)};
    found.guesses = weighed(witnesses, seen);
    found.structure = structure_of(found.guesses.front().object, impression);
    const auto believed = std::ranges::find_if(witnesses, [&](const Witness& witness) {
        return has(witness.objects, found.guesses.front().object);
    });
    found.why = believed == witnesses.end() ? seen.why : believed->why;
    if (believed != witnesses.end() && believed->objects.size() > 1) found.why += "; " + seen.why;
    return found;
}

std::optional<double> light_years_per_px(const Identification& found, double width_px, double height_px) {
    const std::optional<double> degrees = degrees_per_px_of(found.metadata, width_px, height_px);
    if (!degrees || !found.distance_ly) return {};
    return *found.distance_ly * real::radians(*degrees);
}

}  // namespace astrosplat
