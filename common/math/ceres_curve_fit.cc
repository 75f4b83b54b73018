/* ceres_curve_fit.cc - C interface to the Ceres solver. */
#include "common/math/ceres_curve_fit.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <vector>

#include <ceres/ceres.h>

namespace
{

/* All blocks are evaluated together, when Ceres has moved to a point; blocks then copy their part. */
struct evaluation : ceres::EvaluationCallback {
    const struct curve_fit *problem;
    const double *x;
    std::vector<double> residuals, jacobian;

    evaluation(const struct curve_fit *p, const double *at) : problem(p), x(at)
    {
        residuals.resize(static_cast<size_t>(p->blocks) * p->block_size);
        jacobian.resize(residuals.size() * p->unknowns);
    }
    void PrepareForEvaluation(bool derivatives, bool) override
    {
        problem->evaluate(problem->ctx, x, residuals.data(), derivatives ? jacobian.data() : nullptr);
    }
};

struct block : ceres::CostFunction {
    const evaluation *all;
    size_t first;

    block(const evaluation *a, int index) : all(a), first(static_cast<size_t>(index) * a->problem->block_size)
    {
        set_num_residuals(a->problem->block_size);
        mutable_parameter_block_sizes()->push_back(a->problem->unknowns);
    }
    bool Evaluate(double const *const *, double *residuals, double **jacobians) const override
    {
        const size_t rows = static_cast<size_t>(num_residuals()), n = static_cast<size_t>(all->problem->unknowns);
        std::copy_n(all->residuals.data() + first, rows, residuals);
        if (jacobians && jacobians[0]) std::copy_n(all->jacobian.data() + first * n, rows * n, jacobians[0]);
        return true;
    }
};

void set_bounds(ceres::Problem &to, const struct curve_fit *problem, double *x)
{
    for (int i = 0; i < problem->unknowns; i++) {
        if (problem->lower && std::isfinite(problem->lower[i])) to.SetParameterLowerBound(x, i, problem->lower[i]);
        if (problem->upper && std::isfinite(problem->upper[i])) to.SetParameterUpperBound(x, i, problem->upper[i]);
    }
}

} // namespace

enum status ceres_curve_fit(struct curve_fit_outcome *outcome, const struct curve_fit *problem, double *x,
                            struct err *err)
{
    try {
        evaluation all(problem, x);
        ceres::Problem::Options how;
        how.evaluation_callback = &all;
        ceres::Problem ceres_problem(how);
        for (int i = 0; i < problem->blocks; i++)
            ceres_problem.AddResidualBlock(new block(&all, i),
                                           problem->cauchy > 0 ? new ceres::CauchyLoss(problem->cauchy) : nullptr, x);
        set_bounds(ceres_problem, problem, x);

        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.max_num_iterations = problem->iterations;
        options.function_tolerance = 1e-9;
        options.parameter_tolerance = 1e-9;
        options.num_threads = 1;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &ceres_problem, &summary);
        outcome->cost = summary.final_cost;
        outcome->converged = summary.termination_type == ceres::CONVERGENCE;
        outcome->iterations = static_cast<int>(summary.iterations.size());
        if (summary.IsSolutionUsable()) return ST_OK;
        return err_set(err, ST_DATA, "the least-squares solver failed: %s", summary.message.c_str());
    } catch (const std::bad_alloc &) {
        return err_nomem(err, "a least-squares problem", 0);
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "the least-squares solver failed: %s", e.what());
    }
}
