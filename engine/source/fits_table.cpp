#include <fmt/format.h>

#include "core/log.h"
#include "source/file_tables.h"
#include "source/fits_file.h"

namespace astrosplat {
namespace {

constexpr int widest_text = 256;  // characters: beyond, it is no number

class FitsTable final : public RowTable {
  public:
    // Of the current HDU.
    FitsTable(fs::path file, std::shared_ptr<fitsfile> in) : file_(std::move(file)), in_(std::move(in)) {
        int count = 0, status = 0;
        LONGLONG rows = 0;
        fits_get_hdu_num(in_.get(), &hdu_);
        fits_get_num_cols(in_.get(), &count, &status);
        fits_get_num_rowsll(in_.get(), &rows, &status);
        check_fits(file_, "reading a table", status);
        rows_ = rows;
        parts_.resize(std::size_t(count));
        for (int i = 0; i < count; ++i) {
            const auto word = [&](const char* key) {
                return fits_text(in_.get(), fmt::format("{}{}", key, i + 1).c_str());
            };
            const bool single = is_single(i);
            columns_.push_back(
                {single ? lower_case(word("TTYPE")) : "", word("TUNIT"), lower_case(word("TUCD"))});
        }
    }

    bool next() override { return row_ < rows_ && ++row_ > 0; }
    std::int64_t line() const override { return row_; }
    std::string_view field(int column) const override {
        if (column < 0 || columns_[std::size_t(column)].name.empty()) return {};
        Part& part = parts_[std::size_t(column)];
        if (part.first == 0 || row_ < part.first || row_ >= part.first + part.count) read(column, part);
        const auto at = std::size_t(row_ - part.first);
        if (part.width > 0) return part.texts.data() + at * (part.width + 1);
        return part.text = std::isnan(part.numbers[at]) ? "" : shortest(part.numbers[at]);
    }

  private:
    // Some rows of a column.
    struct Part {
        std::int64_t first = 0, count = 0;  // from 1
        std::size_t width = 0;              // of texts; 0: numbers
        std::vector<double> numbers;
        std::vector<char> texts;
        std::string text;
    };

    bool is_single(int column) {
        int type = 0, status = 0, width = 0;
        LONGLONG repeat = 0, bytes = 0;
        fits_get_coltypell(in_.get(), column + 1, &type, &repeat, &bytes, &status);
        fits_get_col_display_width(in_.get(), column + 1, &width, &status);
        fits_clear_errmsg();
        const bool text = type == TSTRING && repeat <= bytes && width > 0 && width <= widest_text;
        if (text) parts_[std::size_t(column)].width = std::size_t(width);
        constexpr std::array numbers = {TBYTE, TSHORT, TLONG, TLONGLONG, TFLOAT, TDOUBLE};
        return status == 0 && (text || (repeat == 1 && std::ranges::find(numbers, type) != numbers.end()));
    }

    void read(int column, Part& part) const {
        int any = 0, status = 0;
        double undefined = std::numeric_limits<double>::quiet_NaN();
        char empty[] = "";
        part.first = row_;
        part.count = std::min<std::int64_t>(4096, rows_ - row_ + 1);
        fits_movabs_hdu(in_.get(), hdu_, nullptr, &status);
        const auto count = std::size_t(part.count);
        part.texts.assign(count * (part.width + 1), '\0');
        part.numbers.resize(count);
        std::vector<char*> texts(count);
        for (std::size_t i = 0; i < count; ++i) texts[i] = part.texts.data() + i * (part.width + 1);
        void* const to = part.width > 0 ? static_cast<void*>(texts.data()) : part.numbers.data();
        void* const none = part.width > 0 ? static_cast<void*>(empty) : &undefined;
        fits_read_col(in_.get(), part.width > 0 ? TSTRING : TDOUBLE, column + 1, row_, 1, part.count, none,
                      to, &any, &status);
        check_fits(file_, "reading a table", status);
    }

    fs::path file_;
    std::shared_ptr<fitsfile> in_;
    int hdu_ = 0;  // from 1
    std::int64_t row_ = 0, rows_ = 0;
    mutable std::vector<Part> parts_;
};

}  // namespace

bool is_equinox_2000(std::string_view equinox) {
    if (equinox.starts_with('J') || equinox.starts_with('j')) equinox.remove_prefix(1);
    return equinox.empty() || parse_double(equinox) == 2000.0;
}

std::vector<FileTable> fits_tables(const fs::path& file, const Progress& progress) {
    const std::shared_ptr<fitsfile> in(open_fits(file, progress));
    std::vector<FileTable> tables;
    const int count = fits_hdu_count(file, in.get());
    for (int hdu = 0; hdu < count; ++hdu) {
        progress.check();
        int type = 0, status = 0;
        fits_movabs_hdu(in.get(), hdu + 1, &type, &status);
        check_fits(file, fmt::format("moving to HDU {}", hdu), status);
        if (type == IMAGE_HDU) continue;
        const std::string name = fits_text(in.get(), "EXTNAME"), frame = fits_text(in.get(), "RADESYS");
        if (!frame.empty() && frame != "ICRS" && frame != "FK5")
            log_warning(fmt::format("{}: RADESYS = '{}' is not followed: places are taken for ICRS",
                                    file.string(), printable(frame)));
        const std::string equinox = fits_text(in.get(), "EQUINOX");
        if (frame != "ICRS" && !is_equinox_2000(equinox))
            log_warning(fmt::format("{}: EQUINOX = {} is not followed: places are taken for ICRS",
                                    file.string(), printable(equinox)));
        tables.push_back({fmt::format("HDU {}{}{}", hdu, name.empty() ? "" : " ", name),
                          std::make_unique<FitsTable>(file, in)});
    }
    return tables;
}

}  // namespace astrosplat
