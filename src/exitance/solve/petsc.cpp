#include <dlfcn.h>
#include <petsc/private/vecimpl.h>
#include <petscksp.h>

#include <limits>
#include <type_traits>

#include "exitance/base/check.hpp"
#include "exitance/processes/value_scatter.hpp"
#include "exitance/solve/gmres.hpp"
#include "exitance/solve/relaxation_watch.hpp"

// All use of PETSc: scatters of vectors that are distributed over processes, and its GMRES on them.
//
// The library is loaded when several processes first need it. If it were linked, every start of the program would load
// it and its eighty dependencies, which doubles the start-up time.

namespace exitance {
namespace {

static_assert(std::is_same_v<PetscScalar, double> && sizeof(Spectrum) == bands * sizeof(PetscScalar));
constexpr auto values_each = static_cast<PetscInt>(bands);

[[noreturn]] void end_without(const char* why) {
    std::fprintf(stderr, "error: PETSc, which several processes need: %s\n", why);
    MPI_Abort(MPI_COMM_WORLD, 1);
    std::abort();
}

/// Ends the program on an error of PETSc, which means a bug in this code or that memory has run out.
void check(PetscErrorCode code) {
    if (code != 0) end_without("a call failed");
}

/// The functions of the library that are used here, with their own names.
struct Petsc {
    void* library = dlopen(EXITANCE_PETSC_LIBRARY, RTLD_LAZY | RTLD_LOCAL);

    template <class Function>
    Function* find(const char* name) const {
        if (!library) end_without(dlerror());
        void* const found = dlsym(library, name);
        if (!found) end_without(dlerror());
        return reinterpret_cast<Function*>(found);
    }

#define EXITANCE_PETSC(name) decltype(::name)* const name = find<decltype(::name)>(#name)
    EXITANCE_PETSC(PetscInitializeNoArguments);
    EXITANCE_PETSC(PetscOptionsSetValue);
    EXITANCE_PETSC(ISCreateBlock);
    EXITANCE_PETSC(ISCreateStride);
    EXITANCE_PETSC(ISDestroy);
    EXITANCE_PETSC(VecCreateMPIWithArray);
    EXITANCE_PETSC(VecCreateSeqWithArray);
    EXITANCE_PETSC(VecPlaceArray);
    EXITANCE_PETSC(VecResetArray);
    EXITANCE_PETSC(VecGetArray);
    EXITANCE_PETSC(VecRestoreArray);
    EXITANCE_PETSC(VecGetArrayRead);
    EXITANCE_PETSC(VecRestoreArrayRead);
    EXITANCE_PETSC(VecDestroy);
    EXITANCE_PETSC(VecScatterCreate);
    EXITANCE_PETSC(VecScatterBegin);
    EXITANCE_PETSC(VecScatterEnd);
    EXITANCE_PETSC(VecScatterDestroy);
    EXITANCE_PETSC(MatCreateShell);
    EXITANCE_PETSC(MatShellSetOperation);
    EXITANCE_PETSC(MatDestroy);
    EXITANCE_PETSC(KSPCreate);
    EXITANCE_PETSC(KSPSetType);
    EXITANCE_PETSC(KSPGetPC);
    EXITANCE_PETSC(PCSetType);
    EXITANCE_PETSC(KSPSetOperators);
    EXITANCE_PETSC(KSPSetInitialGuessNonzero);
    EXITANCE_PETSC(KSPSetTolerances);
    EXITANCE_PETSC(KSPSetConvergenceTest);
    EXITANCE_PETSC(KSPGMRESSetRestart);
    EXITANCE_PETSC(KSPSolve);
    EXITANCE_PETSC(KSPDestroy);
#undef EXITANCE_PETSC
};

/// Loads and initializes the library at the first call, which is collective. MPI finalizes it.
const Petsc& petsc() {
    static const Petsc opened = [] {
        Petsc p;
        // The program handles signals itself, and options that users set for other programs must not apply to it.
        for (const char* option : {"-no_signal_handler", "-skip_petscrc"})
            check(p.PetscOptionsSetValue(nullptr, option, "1"));
        check(p.PetscInitializeNoArguments());
        return p;
    }();
    return opened;
}

double* numbers_of(std::span<Spectrum> values) {
    return reinterpret_cast<double*>(values.data());
}
double* numbers_of(std::span<const Spectrum> values) {
    // PETSc only reads these vectors, but requires a pointer to non-const
    return const_cast<double*>(reinterpret_cast<const double*>(values.data()));
}

/// Creates a vector distributed over processes, with this process's values in an array of ours.
Vec spread_vector(std::size_t own, std::size_t all, const double* numbers) {
    Vec out = nullptr;
    check(petsc().VecCreateMPIWithArray(MPI_COMM_WORLD, values_each, static_cast<PetscInt>(own * bands),
                                        static_cast<PetscInt>(all * bands), numbers, &out));
    return out;
}

/// Scatter from distributed unknowns. PETSc numbers unknowns process by process, in ascending order within each.
class PetscScatter final : public ValueScatter {
  public:
    PetscScatter(const DealtUnknowns& dealt, std::span<const std::uint32_t> read) {
        std::vector<std::size_t> first(dealt.processes() + 1, 0);
        for (std::size_t p = 0; p < dealt.processes(); ++p) first[p + 1] = first[p] + dealt.count_of(p);
        std::vector<PetscInt> numbers;
        numbers.reserve(read.size());
        for (const std::uint32_t j : read)
            numbers.push_back(static_cast<PetscInt>(first[dealt.owner(j)] + dealt.place(j)));
        const auto count = static_cast<PetscInt>(read.size());
        IS from = nullptr, to = nullptr;
        check(petsc().ISCreateBlock(MPI_COMM_SELF, values_each, count, numbers.data(), PETSC_COPY_VALUES, &from));
        check(petsc().ISCreateStride(MPI_COMM_SELF, count * values_each, 0, 1, &to));
        own_ = spread_vector(dealt.own_count(), dealt.count(), nullptr);
        check(petsc().VecCreateSeqWithArray(MPI_COMM_SELF, values_each, count * values_each, nullptr, &fetched_));
        check(petsc().VecScatterCreate(own_, from, fetched_, to, &scatter_));
        check(petsc().ISDestroy(&from)), check(petsc().ISDestroy(&to));
    }
    ~PetscScatter() override {
        check(petsc().VecScatterDestroy(&scatter_));
        check(petsc().VecDestroy(&own_)), check(petsc().VecDestroy(&fetched_));
    }
    PetscScatter(const PetscScatter&) = delete;
    PetscScatter& operator=(const PetscScatter&) = delete;

    void fetch(std::span<const Spectrum> own, std::span<Spectrum> fetched) const override {
        check(petsc().VecPlaceArray(own_, numbers_of(own))),
            check(petsc().VecPlaceArray(fetched_, numbers_of(fetched)));
        check(petsc().VecScatterBegin(scatter_, own_, fetched_, INSERT_VALUES, SCATTER_FORWARD));
        check(petsc().VecScatterEnd(scatter_, own_, fetched_, INSERT_VALUES, SCATTER_FORWARD));
        check(petsc().VecResetArray(own_)), check(petsc().VecResetArray(fetched_));
    }

  private:
    Vec own_ = nullptr, fetched_ = nullptr;
    VecScatter scatter_ = nullptr;
};

/// Access to a vector's own values during the object's lifetime: read-only (const Spectrum) or writable.
template <class Value>
class OwnValues {
    static constexpr bool is_read = std::is_const_v<Value>;
    using Number = std::conditional_t<is_read, const double, double>;

  public:
    explicit OwnValues(Vec vector) : vector_(vector) {
        if constexpr (is_read)
            check(petsc().VecGetArrayRead(vector, &numbers_));
        else
            check(petsc().VecGetArray(vector, &numbers_));
    }
    ~OwnValues() {
        if constexpr (is_read)
            check(petsc().VecRestoreArrayRead(vector_, &numbers_));
        else
            check(petsc().VecRestoreArray(vector_, &numbers_));
    }
    OwnValues(const OwnValues&) = delete;
    OwnValues& operator=(const OwnValues&) = delete;
    std::span<Value> get() const {
        return {reinterpret_cast<Value*>(numbers_), static_cast<std::size_t>(vector_->map->n) / bands};
    }

  private:
    Vec vector_;
    Number* numbers_ = nullptr;
};
using ReadValues = OwnValues<const Spectrum>;
using WrittenValues = OwnValues<Spectrum>;

/// Read access to several vectors.
class ReadVectors {
  public:
    ReadVectors(const Vec* vectors, PetscInt count) {
        for (PetscInt j = 0; j < count; ++j)
            values_.push_back(held_.emplace_back(std::make_unique<ReadValues>(vectors[j]))->get());
    }
    std::span<const std::span<const Spectrum>> get() const { return values_; }

  private:
    std::vector<std::unique_ptr<ReadValues>> held_;
    std::vector<std::span<const Spectrum>> values_;
};

/// State for PETSc's callbacks; there is one solve at a time.
struct Solve {
    const RadiositySystem& system;
    RelaxationWatch watch;
    bool judged = false;
};
Solve* running = nullptr;

PetscErrorCode multiply_by_system(Mat, Vec x, Vec y) {
    apply_system(running->system, ReadValues(x).get(), WrittenValues(y).get());
    ++running->watch.report.iterations;
    return 0;
}

PetscErrorCode judge(KSP, PetscInt, PetscReal residual, KSPConvergedReason* reason, void*) {
    running->judged = true;
    *reason = running->watch.done(residual) ? KSP_CONVERGED_ITS : KSP_CONVERGED_ITERATING;
    return 0;
}

// Vector operations: PETSc's sums depend on the number of processes, and its products on the BLAS library.

PetscErrorCode products(Vec x, PetscInt count, const Vec* y, PetscScalar* out) {
    const ReadVectors known(y, count);
    const std::vector<double> found = running->watch.vectors.products(ReadValues(x).get(), known.get());
    std::copy(found.begin(), found.end(), out);
    return 0;
}

PetscErrorCode product(Vec x, Vec y, PetscScalar* out) {
    return products(x, 1, &y, out);
}

PetscErrorCode norm(Vec x, NormType, PetscReal* out) {
    *out = running->watch.vectors.norm(ReadValues(x).get());
    return 0;
}

PetscErrorCode scale(Vec x, PetscScalar factor) {
    running->watch.vectors.multiply(WrittenValues(x).get(), factor);
    return 0;
}

PetscErrorCode add_multiples(Vec y, PetscInt count, const PetscScalar* factors, Vec* x) {
    const ReadVectors added(x, count);
    running->watch.vectors.add_combination(WrittenValues(y).get(), {factors, added.get().size()}, added.get());
    return 0;
}

PetscErrorCode add_multiple(Vec y, PetscScalar factor, Vec x) {
    return add_multiples(y, 1, &factor, &x);
}

/// Creates a vector that uses these operations; copies of it do so, too.
Vec system_vector(const DealtUnknowns& dealt, double* numbers) {
    Vec out = spread_vector(dealt.own_count(), dealt.count(), numbers);
    out->ops->dot = out->ops->tdot = product;
    out->ops->mdot = out->ops->mtdot = products;
    out->ops->norm = norm;
    out->ops->scale = scale;
    out->ops->axpy = add_multiple;
    out->ops->maxpy = add_multiples;
    return out;
}

}  // namespace

std::shared_ptr<const ValueScatter> make_scatter(const DealtUnknowns& dealt, std::span<const std::uint32_t> read) {
    return std::make_shared<PetscScatter>(dealt, read);
}

SolveReport gmres_over_processes(const RadiositySystem& system, std::span<Spectrum> b, StopRule stop) {
    const Petsc& p = petsc();
    const DealtUnknowns dealt = system.F.dealt();
    Solve solve{system, RelaxationWatch(system, stop)};
    running = &solve;
    Vec rhs = system_vector(dealt, numbers_of(system.rhs)), solution = system_vector(dealt, numbers_of(b));
    const auto own = static_cast<PetscInt>(bands * dealt.own_count()),
               all = static_cast<PetscInt>(bands * dealt.count());
    Mat matrix = nullptr;
    check(p.MatCreateShell(MPI_COMM_WORLD, own, own, all, all, nullptr, &matrix));
    check(p.MatShellSetOperation(matrix, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_by_system)));
    KSP ksp = nullptr;
    PC preconditioner = nullptr;
    check(p.KSPCreate(MPI_COMM_WORLD, &ksp));
    check(p.KSPSetType(ksp, KSPGMRES));
    check(p.KSPGetPC(ksp, &preconditioner));
    check(p.PCSetType(preconditioner, PCNONE));
    check(p.KSPSetOperators(ksp, matrix, matrix));
    check(p.KSPSetInitialGuessNonzero(ksp, PETSC_TRUE));
    check(p.KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, std::numeric_limits<int>::max()));
    check(p.KSPSetConvergenceTest(ksp, judge, nullptr, nullptr));
    check(p.KSPGMRESSetRestart(ksp, gmres_restart));
    check(p.KSPSolve(ksp, rhs, solution));
    if (!solve.judged) solve.watch.done(0.0);  // the initial residual was already zero
    check(p.KSPDestroy(&ksp)), check(p.MatDestroy(&matrix));
    check(p.VecDestroy(&rhs)), check(p.VecDestroy(&solution));
    running = nullptr;
    return solve.watch.report;
}

}  // namespace exitance
