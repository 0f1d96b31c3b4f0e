// While it lives, the process is one of a country that writes 1.000,5.
#pragma once

#include <clocale>
#include <locale>
#include <string>

namespace astrosplat {

/// Decimal comma and grouped digits, for C++ streams; and for C where such a locale is installed.
struct CommaLocale {
    struct Punctuation : std::numpunct<char> {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    std::locale before = std::locale::global(std::locale(std::locale::classic(), new Punctuation));
    CommaLocale() {
        for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"})
            if (std::setlocale(LC_NUMERIC, name)) break;
    }
    ~CommaLocale() {
        std::locale::global(before);
        std::setlocale(LC_NUMERIC, "C");
    }
};

}  // namespace astrosplat
