#include <fmt/format.h>

#include <algorithm>

#include "exitance/cli/json_output.hpp"
#include "exitance/cli/verbs.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/view_factors/operator_file.hpp"
#include "exitance/io/view_factors/thermal_table.hpp"

namespace exitance {
namespace {

Result<void> write_text(const std::string& path, const std::string& text) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    file->write(text);
    return file->commit();
}

/// Error (bad_input) if rows of the view factors are missing.
Result<void> check_rows(const SparseFactors& factors, const std::string& path) {
    const auto missing = std::count(factors.finished.begin(), factors.finished.end(), 0);
    if (missing == 0) return {};
    return Error{ErrorCode::bad_input, fmt::format("{} of its {} rows are missing", missing, factors.size()), path,
                 "finish it with `exitance viewfactors ... --resume`"};
}

std::string words_of(const GrayExchange& exchange, const std::vector<ThermalSurface>& surfaces, bool is_open) {
    const auto [coldest, hottest] = std::minmax_element(exchange.temperature.begin(), exchange.temperature.end());
    double emitted = 0;
    for (const double heat : exchange.heat) emitted += std::max(0.0, heat);
    std::string text = fmt::format("{} surfaces, {:.2f} K to {:.2f} K; {:.6g} W leave the surfaces that lose heat\n",
                                   surfaces.size(), *coldest, *hottest, emitted);
    if (is_open) text += fmt::format("surroundings receive {:.6g} W\n", exchange.surroundings);
    return text;
}

/// Writes the exchange factors and Gebhart's factors that are requested.
Result<void> write_exchange(const HeatArguments& arguments, const SparseFactors& factors,
                            const std::vector<ThermalSurface>& surfaces, const StopRequest& stop) {
    if (arguments.exchange.empty() && arguments.gebhart.empty()) return {};
    auto f = exchange_factors(factors, surfaces, arguments.surroundings, stop);
    if (!f) return f.error();
    if (!arguments.exchange.empty())
        if (auto written = write_text(arguments.exchange, exchange_csv(factors, surfaces, *f)); !written)
            return written;
    if (arguments.gebhart.empty()) return {};
    for (std::size_t i = 0; i < f->size(); ++i)
        for (double& value : (*f)[i]) value /= surfaces[i].emissivity;
    return write_text(arguments.gebhart, exchange_csv(factors, surfaces, *f));
}

}  // namespace

/// Runs `exitance heat FACTORS --table TABLE`.
ExitCode run(const HeatArguments& arguments, Terminal& terminal) {
    const StopRequest& stop = terminal.limits().stop();
    const auto read = read_factors(arguments.factors);
    if (!read) {
        Error error = read.error();
        if (error.code == ErrorCode::bad_input)
            error.hint =
                "heat reads the .h5 files of `exitance viewfactors`, of -o FACTORS.h5 or --operator FACTORS.h5";
        return terminal.fail(error);
    }
    const FactorOperator* const transport = std::get_if<FactorOperator>(&*read);
    const SparseFactors& factors = transport ? transport->rows : std::get<SparseFactors>(*read);
    if (const Result<void> whole = check_rows(factors, arguments.factors); !whole) return terminal.fail(whole.error());
    if (transport && !(arguments.exchange.empty() && arguments.gebhart.empty()))
        return terminal.fail({ErrorCode::usage, "is an operator, which has no exchange factors of single surfaces",
                              arguments.factors, "use the file of `exitance viewfactors SCENE -o FACTORS.h5`"});
    const auto surfaces = read_thermal_table(arguments.table, factors);
    if (!surfaces) return terminal.fail(surfaces.error());
    const Result<GrayExchange> exchange = transport
                                              ? solve_gray_exchange(*transport, *surfaces, arguments.surroundings, stop)
                                              : solve_gray_exchange(factors, *surfaces, arguments.surroundings, stop);
    if (!exchange) return terminal.fail(exchange.error());
    if (!arguments.output.empty())
        if (const auto written = write_text(arguments.output, heat_csv(factors, *surfaces, *exchange)); !written)
            return terminal.fail(written.error());
    if (const Result<void> written = write_exchange(arguments, factors, *surfaces, stop); !written)
        return terminal.fail(written.error());
    if (arguments.json)
        terminal.print(heat_json(*exchange));
    else if (!arguments.quiet)
        terminal.print(words_of(*exchange, *surfaces, arguments.surroundings.has_value()));
    return ExitCode::done;
}

}  // namespace exitance
