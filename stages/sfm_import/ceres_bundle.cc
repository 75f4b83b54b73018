/* ceres_bundle.cc - C interface to Ceres for bundle adjustment [Triggs 2000].
 *
 * Minimised is the sum over the observations of a robust function of the squared reprojection error in units of the
 * noise, plus priors. Unknown are rotations (unit quaternions), centres, points, lens parameters, and a shift of the
 * principal point of each image. Images from one station have one centre.
 *
 * Robustness. Errors follow Student's t distribution with n degrees of freedom [Liu 1995]: a squared error s costs
 * (n + 2) log(1 + s / n), which is Ceres' Cauchy loss times (n + 2) / n. Wrong matches then pull with a bounded
 * force.
 *
 * Priors keep what the pictures do not determine near what is usual: single lens parameters, the ratio of the two
 * focal lengths, and shifts, whose expectation is 0; also poses that a user gave.
 *
 * Rigs. Each image of a multi-lens camera has a residual of six numbers between its pose and that of its capture and
 * its lens's mount, which are unknown too. Images that hold their rotation or their place have none: they are held
 * since little is known of them.
 *
 * Gauge. The scene may be moved, turned and scaled as a whole. Priors of poses hold its frame. Without them the pose of
 * the first image is held, and of the station that is farthest from it the coordinate that the scale changes most.
 *
 * Derivatives are exact: camera_project_derivatives() gives those of the lens, rotate() those of R(q) p, Ceres'
 * automatic differentiation those of a rig's residuals.
 *
 * Solver. Points are eliminated first (Schur complement). Up to 150 images the reduced camera system is dense;
 * beyond, it is sparse and solved by Eigen. One thread, and no CHOLMOD with a threaded BLAS: sums keep their order,
 * so the same input gives the same bits.
 *
 * ceres_bundle_shift_sigma() gives the standard errors of the shifts from the inverse of the information matrix, by
 * a sparse QR of the Jacobian. */
#include "stages/sfm_import/ceres_bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <glog/logging.h>

#include <memory>
#include <vector>

namespace
{

enum { ROTATION, CENTER, POINT, SHIFT, LENS, BLOCKS };

/* d(R(q) p)/dq of a unit quaternion w x y z. */
void rotate(const double *q, const double *p, double out[3], double d_rotation[3][4], double matrix[3][3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double m[3][3] = {{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
                            {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
                            {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    const double d[3][4] = {{w * p[0] - z * p[1] + y * p[2], x * p[0] + y * p[1] + z * p[2],
                             -y * p[0] + x * p[1] + w * p[2], -z * p[0] - w * p[1] + x * p[2]},
                            {z * p[0] + w * p[1] - x * p[2], y * p[0] - x * p[1] - w * p[2],
                             x * p[0] + y * p[1] + z * p[2], w * p[0] - z * p[1] + y * p[2]},
                            {-y * p[0] + x * p[1] + w * p[2], z * p[0] + w * p[1] - x * p[2],
                             -w * p[0] + z * p[1] - y * p[2], x * p[0] + y * p[1] + z * p[2]}};
    for (int i = 0; i < 3; i++) {
        out[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2];
        for (int j = 0; j < 4; j++) d_rotation[i][j] = 2 * d[i][j];
        for (int j = 0; j < 3; j++) matrix[i][j] = m[i][j];
    }
}

/* The residual of an observation in units of its noise. */
class reprojection : public ceres::CostFunction
{
  public:
    reprojection(enum camera_model model, double u, double v, double noise) : model_(model), u_(u), v_(v), noise_(noise)
    {
        set_num_residuals(2);
        for (int size : {4, 3, 3, 2, camera_model_params(model)}) mutable_parameter_block_sizes()->push_back(size);
    }
    bool Evaluate(double const *const *x, double *residuals, double **jacobians) const override
    {
        const int params = camera_model_params(model_);
        struct camera c = {};
        double rotated[3], d_rotation[3][4], matrix[3][3], pixel[2], d_point[2][3], d_params[2][CAMERA_MAX_PARAMS];
        c.model = model_;
        for (int i = 0; i < params; i++) c.params[i] = x[LENS][i];
        const double from_center[3] = {x[POINT][0] - x[CENTER][0], x[POINT][1] - x[CENTER][1],
                                       x[POINT][2] - x[CENTER][2]};
        rotate(x[ROTATION], from_center, rotated, d_rotation, matrix);
        const struct vec3 p = {rotated[0], rotated[1], rotated[2]};
        if (!camera_project_derivatives(&c, p, pixel, d_point, d_params)) return false;
        residuals[0] = (pixel[0] + x[SHIFT][0] - u_) / noise_;
        residuals[1] = (pixel[1] + x[SHIFT][1] - v_) / noise_;
        if (!jacobians) return true;
        for (int r = 0; r < 2; r++) {
            for (int j = 0; j < 4 && jacobians[ROTATION]; j++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) sum += d_point[r][k] * d_rotation[k][j];
                jacobians[ROTATION][4 * r + j] = sum / noise_;
            }
            for (int j = 0; j < 3; j++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) sum += d_point[r][k] * matrix[k][j];
                if (jacobians[POINT]) jacobians[POINT][3 * r + j] = sum / noise_;
                if (jacobians[CENTER]) jacobians[CENTER][3 * r + j] = -sum / noise_;
            }
            for (int j = 0; j < 2 && jacobians[SHIFT]; j++) jacobians[SHIFT][2 * r + j] = (r == j) / noise_;
            for (int j = 0; j < params && jacobians[LENS]; j++)
                jacobians[LENS][params * r + j] = d_params[r][j] / noise_;
        }
        return true;
    }

  private:
    enum camera_model model_;
    double u_, v_, noise_;
};

/* The prior of one number of a block: (x[at] - expected) / sigma. */
class prior : public ceres::CostFunction
{
  public:
    prior(int size, int at, double expected, double sigma) : size_(size), at_(at), expected_(expected), sigma_(sigma)
    {
        set_num_residuals(1);
        mutable_parameter_block_sizes()->push_back(size);
    }
    bool Evaluate(double const *const *x, double *residuals, double **jacobians) const override
    {
        residuals[0] = (x[0][at_] - expected_) / sigma_;
        for (int i = 0; i < size_ && jacobians && jacobians[0]; i++) jacobians[0][i] = i == at_ ? 1 / sigma_ : 0;
        return true;
    }

  private:
    int size_, at_;
    double expected_, sigma_;
};

/* The prior of a rotation: the angles between it and the expected one, about three axes, in units of their sigma. */
class turn_prior : public ceres::CostFunction
{
  public:
    turn_prior(const double expected[4], double sigma) : sigma_(sigma)
    {
        for (int i = 0; i < 4; i++) q_[i] = expected[i];
        set_num_residuals(3);
        mutable_parameter_block_sizes()->push_back(4);
    }
    bool Evaluate(double const *const *x, double *residuals, double **jacobians) const override
    {
        /* twice the vector of x conj(q), which is linear in x */
        const double rows[3][4] = {
            {-q_[1], q_[0], -q_[3], q_[2]}, {-q_[2], q_[3], q_[0], -q_[1]}, {-q_[3], -q_[2], q_[1], q_[0]}};
        for (int r = 0; r < 3; r++) {
            residuals[r] = 0;
            for (int k = 0; k < 4; k++) residuals[r] += 2 * rows[r][k] * x[0][k] / sigma_;
            for (int k = 0; k < 4 && jacobians && jacobians[0]; k++) jacobians[0][4 * r + k] = 2 * rows[r][k] / sigma_;
        }
        return true;
    }

  private:
    double q_[4], sigma_;
};

/* The difference of an image's pose from that of its capture and mount, in units of the sigmas: the angles about three
 * axes, and the place in the body. */
struct rig_residual {
    double turn_sigma, sigma;

    template <typename T>
    bool operator()(const T *rotation, const T *center, const T *body_rotation, const T *body_center,
                    const T *mount_rotation, const T *mount_center, T *residuals) const
    {
        T expected[4], turn[4], in_body[3];
        ceres::QuaternionProduct(mount_rotation, body_rotation, expected);
        const T inverse[4] = {expected[0], -expected[1], -expected[2], -expected[3]};
        ceres::QuaternionProduct(rotation, inverse, turn);
        const double twice = turn[0] < T(0) ? -2 : 2; /* q and -q are one rotation */
        const T offset[3] = {center[0] - body_center[0], center[1] - body_center[1], center[2] - body_center[2]};
        ceres::UnitQuaternionRotatePoint(body_rotation, offset, in_body);
        for (int k = 0; k < 3; k++) {
            residuals[k] = turn[1 + k] * (twice / turn_sigma);
            residuals[3 + k] = (in_body[k] - mount_center[k]) / sigma;
        }
        return true;
    }
};

/* The prior of a lens's ratio of focal lengths, its first two numbers. */
class aspect_prior : public ceres::CostFunction
{
  public:
    aspect_prior(int size, double expected, double sigma) : size_(size), expected_(expected), sigma_(sigma)
    {
        set_num_residuals(1);
        mutable_parameter_block_sizes()->push_back(size);
    }
    bool Evaluate(double const *const *x, double *residuals, double **jacobians) const override
    {
        const double ratio = x[0][1] / x[0][0];
        residuals[0] = (ratio - expected_) / sigma_;
        if (!jacobians || !jacobians[0]) return true;
        for (int i = 0; i < size_; i++) jacobians[0][i] = 0;
        jacobians[0][0] = -ratio / x[0][0] / sigma_;
        jacobians[0][1] = 1 / x[0][0] / sigma_;
        return true;
    }

  private:
    int size_;
    double expected_, sigma_;
};

void add_lens(ceres::Problem *problem, struct bundle_lens *lens, bool is_fixed)
{
    const int params = camera_model_params(lens->camera.model);
    std::vector<int> fixed;
    problem->AddParameterBlock(lens->camera.params, params);
    if (is_fixed) {
        problem->SetParameterBlockConstant(lens->camera.params);
        return;
    }
    for (int i = 0; i < params; i++) {
        if (!lens->free[i])
            fixed.push_back(i);
        else if (lens->sigma[i] > 0)
            problem->AddResidualBlock(new prior(params, i, lens->expected[i], lens->sigma[i]), nullptr,
                                      lens->camera.params);
    }
    if (lens->aspect_sigma > 0)
        problem->AddResidualBlock(new aspect_prior(params, lens->aspect, lens->aspect_sigma), nullptr,
                                  lens->camera.params);
    if ((int)fixed.size() == params)
        problem->SetParameterBlockConstant(lens->camera.params);
    else if (!fixed.empty())
        problem->SetManifold(lens->camera.params, new ceres::SubsetManifold(params, fixed));
}

/* The scene may be moved, turned and scaled as a whole. Fixes that: the pose of the first image, and of the station
 * farthest from it the coordinate that the scale changes most. */
void fix_frame(ceres::Problem *problem, struct bundle *b)
{
    struct bundle_image *first = nullptr;
    struct bundle_station *origin = nullptr, *second = nullptr;
    double farthest = 0;
    for (int i = 0; i < b->image_count; i++) {
        struct bundle_image *im = &b->images[i];
        struct bundle_station *s = &b->stations[im->station];
        if (!problem->HasParameterBlock(im->rotation)) continue;
        if (!first) {
            first = im;
            origin = s;
        }
        double square = 0;
        for (int k = 0; k < 3; k++) square += (s->center[k] - origin->center[k]) * (s->center[k] - origin->center[k]);
        if (square <= farthest) continue;
        farthest = square;
        second = s;
    }
    if (!second) return;
    int at = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(second->center[k] - origin->center[k]) > fabs(second->center[at] - origin->center[at])) at = k;
    problem->SetParameterBlockConstant(first->rotation);
    problem->SetParameterBlockConstant(origin->center);
    if (!second->fixed) problem->SetManifold(second->center, new ceres::SubsetManifold(3, {at}));
}

/* Priors of the poses that are adjusted. */
void add_pose_priors(ceres::Problem *problem, struct bundle *b)
{
    for (int i = 0; i < b->station_count; i++) {
        struct bundle_station *s = &b->stations[i];
        for (int k = 0; k < 3 && !s->fixed && problem->HasParameterBlock(s->center); k++)
            problem->AddResidualBlock(new prior(3, k, s->expected[k], b->center_sigma), nullptr, s->center);
    }
    for (int i = 0; i < b->image_count; i++) {
        struct bundle_image *im = &b->images[i];
        if (!im->fixed && problem->HasParameterBlock(im->rotation))
            problem->AddResidualBlock(new turn_prior(im->expected, b->turn_sigma), nullptr, im->rotation);
    }
}

/* Ties the images of a rig, whose unknowns join those of the images that are adjusted. */
void add_rig(ceres::Problem *problem, struct bundle *b)
{
    for (int i = 0; i < b->image_count; i++) {
        struct bundle_image *im = &b->images[i];
        struct bundle_station *s = &b->stations[im->station];
        if (im->capture < 0 || im->fixed || s->fixed || !problem->HasParameterBlock(im->rotation)) continue;
        struct bundle_frame *capture = &b->captures[im->capture], *mount = &b->mounts[im->mount];
        for (double *rotation : {capture->rotation, mount->rotation})
            if (!problem->HasParameterBlock(rotation))
                problem->AddParameterBlock(rotation, 4, new ceres::QuaternionManifold);
        problem->AddResidualBlock(new ceres::AutoDiffCostFunction<rig_residual, 6, 4, 3, 4, 3, 4, 3>(
                                      new rig_residual{b->mount_turn_sigma, b->mount_sigma}),
                                  nullptr, im->rotation, s->center, capture->rotation, capture->center, mount->rotation,
                                  mount->center);
        if (im->mount) continue;
        problem->SetParameterBlockConstant(mount->rotation);
        problem->SetParameterBlockConstant(mount->center);
    }
}

std::unique_ptr<ceres::Problem> make_problem(struct bundle *b)
{
    std::unique_ptr<ceres::Problem> problem(new ceres::Problem);
    std::vector<bool> seen(b->image_count), used(b->lens_count);
    for (size_t i = 0; i < b->observation_count; i++) seen[b->observations[i].image] = true;
    for (int i = 0; i < b->image_count; i++)
        if (seen[i]) used[b->images[i].lens] = true;
    for (int i = 0; i < b->lens_count; i++)
        if (used[i]) add_lens(problem.get(), &b->lenses[i], b->points_only);
    for (int i = 0; i < b->image_count; i++) {
        struct bundle_image *im = &b->images[i];
        if (!seen[i]) continue;
        problem->AddParameterBlock(im->rotation, 4, new ceres::QuaternionManifold);
        struct bundle_station *s = &b->stations[im->station];
        problem->AddParameterBlock(s->center, 3);
        problem->AddParameterBlock(im->shift, 2);
        if (im->fixed || b->points_only) problem->SetParameterBlockConstant(im->rotation);
        if (s->fixed || b->points_only) problem->SetParameterBlockConstant(s->center);
        if (!(b->shift_sigma > 0) || b->points_only) problem->SetParameterBlockConstant(im->shift);
        for (int k = 0; k < 2 && b->shift_sigma > 0 && !b->points_only; k++)
            problem->AddResidualBlock(new prior(2, k, 0, b->shift_sigma), nullptr, im->shift);
    }
    /* (n + 2) log(1 + s / n) = (n + 2) / n times Cauchy's n log(1 + s / n); one object serves all observations */
    auto *loss = new ceres::ScaledLoss(new ceres::CauchyLoss(sqrt(b->freedom)), (b->freedom + 2) / b->freedom,
                                       ceres::TAKE_OWNERSHIP);
    for (size_t i = 0; i < b->observation_count; i++) {
        const struct bundle_observation *o = &b->observations[i];
        struct bundle_image *im = &b->images[o->image];
        struct bundle_lens *lens = &b->lenses[im->lens];
        problem->AddResidualBlock(new reprojection(lens->camera.model, o->u, o->v, b->noise), loss, im->rotation,
                                  b->stations[im->station].center, b->points[o->point], im->shift, lens->camera.params);
    }
    if (b->mount_sigma > 0 && !b->points_only) add_rig(problem.get(), b);
    if (b->center_sigma > 0 && !b->points_only)
        add_pose_priors(problem.get(), b);
    else if (!b->points_only)
        fix_frame(problem.get(), b);
    return problem;
}

enum { DENSE_IMAGES = 150 }; /* up to which the reduced camera system is solved as a dense one */

enum status adjust(struct bundle *b, struct err *err)
{
    std::unique_ptr<ceres::Problem> problem = make_problem(b);
    ceres::Solver::Options options;
    auto *order = new ceres::ParameterBlockOrdering;
    for (int i = 0; i < b->point_count; i++)
        if (problem->HasParameterBlock(b->points[i])) order->AddElementToGroup(b->points[i], 0);
    std::vector<double *> blocks;
    problem->GetParameterBlocks(&blocks);
    for (double *block : blocks)
        if (!order->IsMember(block)) order->AddElementToGroup(block, 1);
    if (b->points_only)
        delete order; /* there is one group alone */
    else
        options.linear_solver_ordering.reset(order);
    options.linear_solver_type = b->points_only                   ? ceres::SPARSE_NORMAL_CHOLESKY
                                 : b->image_count <= DENSE_IMAGES ? ceres::DENSE_SCHUR
                                                                  : ceres::SPARSE_SCHUR;
    options.dense_linear_algebra_library_type = ceres::EIGEN;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE; /* one thread, unlike CHOLMOD with BLAS */
    options.max_num_iterations = b->iterations;
    options.function_tolerance = b->tolerance;
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    FLAGS_minloglevel = google::FATAL; /* a step that fails is tried again with more damping */
    ceres::Solve(options, problem.get(), &summary);
    if (summary.IsSolutionUsable()) return ST_OK;
    return err_set(err, ST_DATA, "bundle adjustment failed: %s", summary.message.c_str());
}

enum status find_shift_sigma(double *sigma, struct bundle *b, struct err *err)
{
    std::unique_ptr<ceres::Problem> problem = make_problem(b);
    ceres::Covariance::Options options;
    std::vector<const double *> wanted;
    for (int i = 0; i < b->image_count; i++)
        if (problem->HasParameterBlock(b->images[i].shift)) wanted.push_back(b->images[i].shift);
    options.num_threads = 1;
    options.algorithm_type = ceres::SPARSE_QR;
    ceres::Covariance covariance(options);
    if (!covariance.Compute(wanted, problem.get()))
        return err_set(err, ST_DATA, "the covariance of the principal points cannot be computed");
    for (int i = 0; i < b->image_count; i++) {
        double block[4] = {0, 0, 0, 0};
        if (problem->HasParameterBlock(b->images[i].shift))
            covariance.GetCovarianceBlock(b->images[i].shift, b->images[i].shift, block);
        sigma[2 * i] = sqrt(block[0]);
        sigma[2 * i + 1] = sqrt(block[3]);
    }
    return ST_OK;
}

/* Calls one of these; what C++ throws becomes an error. */
template <typename call> enum status guard(call what, struct err *err)
{
    try {
        return what();
    } catch (const std::bad_alloc &) {
        return err_nomem(err, "a bundle adjustment", 0);
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "bundle adjustment failed: %s", e.what());
    }
}

} // namespace

enum status ceres_bundle_adjust(struct bundle *b, struct err *err)
{
    return guard([=] { return adjust(b, err); }, err);
}

enum status ceres_bundle_shift_sigma(double *sigma, struct bundle *b, struct err *err)
{
    return guard([=] { return find_shift_sigma(sigma, b, err); }, err);
}
