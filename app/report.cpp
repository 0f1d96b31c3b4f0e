#include "report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "core/text.h"

namespace astrosplat {
namespace {

bool is_plain_list(const Report& value) {
    if (!value.is_array()) return false;
    for (const Report& item : value) {
        if (item.is_structured()) return false;
    }
    return true;
}

std::string plain_text(const Report& value) {
    if (value.is_string()) return printable(value.get<std::string>());
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_float()) return fmt::format("{:.7g}", value.get<double>());
    if (!value.is_array()) return value.dump();
    std::string line;
    for (const Report& item : value) line += (line.empty() ? "" : ", ") + plain_text(item);
    return line;
}

void print_lines(const Report& report, int indent) {
    for (const auto& entry : report.items()) {
        const std::string name = report.is_array() ? "-" : printable(entry.key()) + ":";
        if (!entry.value().is_structured() || is_plain_list(entry.value())) {
            fmt::print("{:{}}{} {}\n", "", indent, name, plain_text(entry.value()));
        } else {
            fmt::print("{:{}}{}\n", "", indent, name);
            print_lines(entry.value(), indent + 2);
        }
    }
}

}  // namespace

Report number(double value) {
    if (std::isfinite(value)) return value;
    return fmt::format("{}", value);
}

void print_report(const Report& report, bool json) {
    if (json) {
        fmt::print("{}\n", report.dump(2, ' ', false, Report::error_handler_t::replace));
    } else {
        print_lines(report, 0);
    }
}

}  // namespace astrosplat
