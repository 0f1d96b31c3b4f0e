#include "core/shown.h"

#include "core/text.h"

namespace astrosplat {

std::string shown(std::string_view word) {
    constexpr std::size_t most = 40;
    return "'" + printable(word.substr(0, most)) + (word.size() > most ? "...'" : "'");
}

}  // namespace astrosplat
