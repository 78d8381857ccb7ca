#include "exitance/api/inside.hpp"
#include "exitance/io/view_factors/operator_file.hpp"
#include "exitance/view_factors.hpp"
#include "exitance/view_factors/factor_operator.hpp"
#include "exitance/view_factors/row_factors.hpp"

namespace exitance::api {

struct TransportOperatorData {
    FactorOperator transport;
};

namespace {

TransportOperator wrapped(FactorOperator transport) {
    return TransportOperator(
        std::make_shared<const TransportOperatorData>(TransportOperatorData{std::move(transport)}));
}

using Product = void (FactorOperator::*)(std::span<const double>, std::span<double>) const;

Result<std::vector<double>> product(const FactorOperator& F, Product by, const std::vector<double>& x) {
    return take_turn<std::vector<double>>([&]() -> Result<std::vector<double>> {
        if (x.size() != F.size()) return usage("must have one value per face", "x");
        std::vector<double> y(F.size());
        (F.*by)(x, y);
        return y;
    });
}

}  // namespace

std::size_t TransportOperator::size() const {
    return data_->transport.size();
}
const std::vector<double>& TransportOperator::areas() const {
    return data_->transport.rows.areas;
}
const std::vector<double>& TransportOperator::emittances() const {
    return data_->transport.rows.emittances;
}
const std::vector<double>& TransportOperator::sky() const {
    return data_->transport.rows.sky;
}
const std::vector<double>& TransportOperator::back() const {
    return data_->transport.rows.back;
}
const std::vector<double>& TransportOperator::row_errors() const {
    return data_->transport.rows.row_errors;
}
double TransportOperator::closure_defect() const {
    return data_->transport.closure_defect();
}

Result<std::vector<double>> TransportOperator::apply(const std::vector<double>& x) const {
    return product(data_->transport, &FactorOperator::apply, x);
}

Result<std::vector<double>> TransportOperator::apply_transposed(const std::vector<double>& x) const {
    return product(data_->transport, &FactorOperator::apply_transposed, x);
}

Result<void> TransportOperator::save(const std::string& path) const {
    return take_turn<void>(
        [&] { return to_api(write_factor_operator(path, data_->transport, exitance::StopRequest())); });
}

Result<TransportOperator> transport_operator(const Scene& scene, const ViewFactorOptions& options,
                                             const Control& control) {
    return take_turn<TransportOperator>(control, [&](Run& run) -> Result<TransportOperator> {
        if (const std::optional<Error> misuse = find_misuse(scene, options)) return *misuse;
        if (options.tolerance)
            return usage("is not supported by operators, whose far faces share entries", "tolerance", "give an error");
        const ThreadsOfCall threads(options.threads);
        run.limit_time(options.time_limit);
        const RowFactorOptions in = operator_table_options(options.error, options.smallest, options.seed);
        const exitance::Scene& inside = *scene.data().scene;
        SparseFactors table = compute_row_factors(inside, in, nullptr, run.progress(), run.stop());
        if (!table.combined) return stopped("the computation of the operator, which needs all rows");
        return wrapped(make_factor_operator(make_view_faces(inside), std::move(table), node_share * options.error));
    });
}

Result<TransportOperator> load_transport_operator(const std::string& path) {
    return take_turn<TransportOperator>([&]() -> Result<TransportOperator> {
        exitance::Result<FactorOperator> read = read_factor_operator(path);
        if (!read) return to_api(read.error());
        return wrapped(std::move(*read));
    });
}

}  // namespace exitance::api
