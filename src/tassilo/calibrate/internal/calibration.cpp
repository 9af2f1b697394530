#include "tassilo/calibrate/internal/calibration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/calibrate/internal/frame_places.h"
#include "tassilo/calibrate/internal/lens.h"
#include "tassilo/calibrate/internal/start.h"

namespace tassilo {
namespace {

constexpr double kFirstLoss = 1;      ///< [px]
constexpr double kLoss = 3;           ///< In standard deviations, while outliers are looked for.
constexpr double kLeastSigma = 1e-4;  ///< Points are never measured better. [px]
constexpr double kBelief = 20;        ///< In residuals.
constexpr std::size_t kMarkings = 4;  ///< Of outliers, each after a fit without the last ones.
constexpr double kHarmless = .02;     ///< A point is no outlier for less. [px]
constexpr double kFarOff = 1000;      ///< Stands for points without an image. [px]
constexpr double kHarmlessView = .1;  ///< A view is not thrown out for less. [px]

constexpr double kFirstFrameSigma = .1;  ///< Before it is measured. [px]
constexpr int kFrameRounds = 4;          ///< Of fits, each with the weights and outliers of the last.
constexpr double kLeastPlaces = 8;       ///< On a side, for it to count.
constexpr std::size_t kAlikePlaces = 4;  ///< Neighbors on each side that likeness is looked for among: a pitch.
constexpr double kContradiction = 5;     ///< Standard deviations of how far frames may move the camera.

const std::string kSubject = "calibration";

std::string px(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%.2f px", value);
  return out;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Indices of camera parameters that stay 0.
std::vector<int> fixed_parameters(const IntrinsicsOptions& options) {
  std::vector<int> fixed;
  const auto radial = options.model == LensModel::plumb_bob     ? std::vector{4, 5, 8}
                      : options.model == LensModel::equidistant ? std::vector{4, 5, 6, 7}
                                                                : std::vector{4};
  const std::size_t terms = options.radial_terms == 0 ? radial.size() : static_cast<std::size_t>(options.radial_terms);
  for (std::size_t i = terms; i < radial.size(); ++i) fixed.push_back(radial[i]);
  if (options.model == LensModel::plumb_bob && !options.tangential) fixed.insert(fixed.end(), {6, 7});
  std::ranges::sort(fixed);
  return fixed;
}

}  // namespace

Calibration::Calibration(ImageSize size, const std::vector<TargetView>& views, const IntrinsicsOptions& options)
    : size_(size),
      views_(views),
      options_(options),
      fixed_(fixed_parameters(options)),
      bundle_(options.model, views),
      rejected_(views.size()),
      sigmas_(views.size(), 1),
      frame_sigmas_(views.size()) {}

void Calibration::run() {
  const auto division = start_from_homographies(size_, views_);
  const auto start = division ? convert_start(division->state, size_, options_.model, fixed_) : std::nullopt;
  if (!start) throw Error(kSubject, "no camera explains the views; some may show another target than told");
  if (options_.ordinary_lens) bundle_.expect_ordinary_lens(size_, division->state.camera);
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (!division->placed[v] || !bundle_.shows(*start, v)) {
      bundle_.use_view(v, false);
      rejected_[v] = "no pose of its target explains it";
    }
  check_view_count();
  fit(*start, kFirstLoss);
  if (place_others()) fit(state_, kFirstLoss);
  sigmas_ = robust_sigmas();
  throw_out();
  // Without a loss the standard deviations are those of least squares; each view's weight follows from its residuals.
  for (int round = 0; round < 3; ++round) {
    fit(state_, 0);
    sigmas_ = estimated_sigmas();
  }
  covariance_ = covariance_now();
  if (options_.frames) add_frames();
}

void Calibration::add_frames() {
  const BundleState by_points = state_;
  const Sigmas sigmas_by_points = sigmas_;
  bool any = false;
  state_.frames.assign(views_.size(), {kFrameDistance, kFrameDistance, kFrameDistance, kFrameDistance});
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (bundle_.uses_view(v) && !views_[v].frame.empty()) {
      frame_sigmas_[v].fill(kFirstFrameSigma);
      bundle_.use_frame(v, frame_sigmas_[v]);
      any = true;
    }
  if (!any) return;
  bool fits = true;
  try {
    for (int round = 0; round < kFrameRounds && any; ++round) {
      fit(state_, 0);
      sigmas_ = estimated_sigmas();
      any = weigh_frames();
    }
  } catch (const Error&) {  // sides that are none can lead anywhere; the points alone stand
    fits = false;
  }
  if (!fits) {
    frames_rejected_ = "no camera explains them together with the dots";
  } else if (!any) {
    frames_rejected_ = "the sides of frames are not straight or too little of them is seen";
  } else {
    // The better of two estimates that agree differs from the other by what its covariance is smaller.
    const Eigen::MatrixXd both = covariance_now();
    std::vector<Eigen::Index> free;
    for (std::size_t i = 0; i < state_.camera.size(); ++i)
      if (std::ranges::find(fixed_, static_cast<int>(i)) == fixed_.end()) free.push_back(static_cast<Eigen::Index>(i));
    const auto n = static_cast<Eigen::Index>(free.size());
    Eigen::VectorXd moved(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(free[static_cast<std::size_t>(i)]);
      moved[i] = state_.camera[k] - by_points.camera[k];
    }
    const Eigen::VectorXd scale = covariance_(free, free).diagonal().cwiseSqrt();
    const Eigen::MatrixXd scaled =
        (Eigen::MatrixXd(covariance_(free, free)).array() / (scale * scale.transpose()).array()).matrix();
    const Eigen::VectorXd in_sigmas = moved.cwiseQuotient(scale);
    const double off = in_sigmas.dot(scaled.ldlt().solve(in_sigmas)), expected = static_cast<double>(n);
    if (off <= expected + kContradiction * std::sqrt(2 * expected)) {
      covariance_ = both;
      return;
    }
    frames_rejected_ = "frames contradict the dots within them";
  }
  for (std::size_t v = 0; v < views_.size(); ++v) bundle_.use_frame(v, frame_sigmas_[v] = {});
  state_ = by_points;
  sigmas_ = sigmas_by_points;
}

bool Calibration::weigh_frames() {
  struct Sum {
    double squares = 0, count = 0;
    double mean() const { return squares / std::max(1., count - 1); }  // less where the side is
  };
  std::vector<std::array<Sum, 4>> of(views_.size());
  std::vector<double> usual;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const auto residuals = bundle_.frame_residuals(state_, v);
    for (std::size_t side = 0; side < 4; ++side) {
      if (!(frame_sigmas_[v][side] > 0)) continue;
      std::vector<double> sizes;
      for (std::size_t i = 0; i < residuals.size(); ++i)
        if (static_cast<std::size_t>(views_[v].frame[i].side) == side && residuals[i])
          sizes.push_back(std::abs(*residuals[i]));
      const double limit = std::max(kHarmless, options_.outlier_ratio * 1.4826 * median_of(sizes));
      Sum& sum = of[v][side];
      for (std::size_t i = 0; i < residuals.size(); ++i) {
        if (static_cast<std::size_t>(views_[v].frame[i].side) != side) continue;
        const bool is_inlier = residuals[i] && std::abs(*residuals[i]) <= limit;
        bundle_.use_frame_place(v, i, is_inlier);
        sum.squares += is_inlier ? *residuals[i] * *residuals[i] : 0;
        sum.count += is_inlier;
      }
      if (sum.count >= kLeastPlaces) usual.push_back(sum.mean());
    }
  }
  const double middle = median_of(usual);
  bool any = false;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (std::size_t side = 0; side < 4; ++side) {
      const Sum& sum = of[v][side];
      const double square = (sum.squares + kBelief * middle) / (std::max(0., sum.count - 1) + kBelief);
      const double most = std::max(kHarmlessView, options_.outlier_ratio * sigmas_[v]);
      const bool counts = sum.count >= kLeastPlaces && std::sqrt(sum.mean()) < most;
      frame_sigmas_[v][side] = counts ? std::max(kLeastSigma, std::sqrt(square)) : 0;
      any = any || counts;
    }
    bundle_.use_frame(v, frame_sigmas_[v]);
  }
  return any;
}

int Calibration::frame_places() const {
  int count = 0;
  for (std::size_t v = 0; v < views_.size(); ++v)
    for (std::size_t i = 0; i < views_[v].frame.size(); ++i) count += bundle_.uses_frame_place(v, i);
  return count;
}

double Calibration::frame_likeness() const {
  double products = 0, pairs = 0, squares = 0, count = 0, sides = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const auto& places = views_[v].frame;
    const auto residuals = bundle_.frame_residuals(state_, v);
    std::vector<std::optional<double>> in_sigmas;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool counts = bundle_.uses_frame_place(v, i) && residuals[i];
      const double sigma = frame_sigmas_[v][static_cast<std::size_t>(places[i].side)];
      in_sigmas.push_back(counts ? std::optional(*residuals[i] / sigma) : std::nullopt);
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!in_sigmas[i]) continue;
      squares += *in_sigmas[i] * *in_sigmas[i];
      ++count;
      for (std::size_t k = i + 1; k < std::min(places.size(), i + kAlikePlaces + 1); ++k)
        if (in_sigmas[k] && places[k].side == places[i].side) {
          products += 2 * *in_sigmas[i] * *in_sigmas[k];
          pairs += 2;
        }
    }
    for (const double sigma : frame_sigmas_[v]) sides += sigma > 0;
  }
  // Where a side is, is fitted to its places, which makes their residuals differ.
  return squares > 0 ? std::max(1., 1 + products / squares + sides / count * pairs / count) : 1;
}

double Calibration::rms(const BundleState& state, const std::vector<bool>& marked) const {
  double sum = 0, count = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!marked[v]) continue;
    const auto residuals = bundle_.residuals(state, v);
    for (std::size_t i = 0; i < residuals.size(); ++i)
      if (bundle_.is_inlier(v, i) && residuals[i]) {
        sum += residuals[i]->squaredNorm();
        ++count;
      }
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}
double Calibration::rms() const { return rms(state_, used_views()); }

std::vector<bool> Calibration::used_views() const {
  std::vector<bool> used;
  for (std::size_t v = 0; v < views_.size(); ++v) used.push_back(bundle_.uses_view(v));
  return used;
}

ViewResult Calibration::view_result(std::size_t v) const {
  ViewResult out{rejected_[v], pose_from(state_.poses[v]), 0, {}};
  std::vector<bool> only(views_.size(), false);
  only[v] = true;
  out.rms_px = rms(state_, only);
  const auto residuals = bundle_.residuals(state_, v);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const Eigen::Vector2d r = residuals[i].value_or(Eigen::Vector2d::Zero());
    out.points.push_back(
        {views_[v].points[i].pixel, {r.x(), r.y()}, residuals[i].has_value() && bundle_.is_inlier(v, i)});
  }
  return out;
}

std::optional<double> Calibration::cross_validated() {
  std::vector<std::size_t> used;
  // Kinds of targets one after the other, so that each fold has its share of each.
  for (const TargetKind kind : {TargetKind::dots, TargetKind::checkerboard, TargetKind::april_grid})
    for (std::size_t v = 0; v < views_.size(); ++v)
      if (bundle_.uses_view(v) && views_[v].target.kind == kind) used.push_back(v);
  const std::size_t folds = std::min(static_cast<std::size_t>(options_.folds), used.size());
  if (folds < 2 || used.size() - (used.size() + folds - 1) / folds < static_cast<std::size_t>(kLeastViews))
    return std::nullopt;
  double sum = 0, count = 0;
  bool all_converged = true;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    const auto select = [&](bool left_out) {
      for (std::size_t i = 0; i < used.size(); ++i) bundle_.use_view(used[i], (i % folds == fold) == left_out);
    };
    select(false);
    const BundleFit others = bundle_.fit(state_, fixed_, sigmas_, 0);
    select(true);
    const BundleFit fit = bundle_.fit_poses(others.state, kFirstLoss);
    all_converged = all_converged && others.converged && fit.converged;
    const double off = rms(fit.state, used_views());
    double points = 0;
    for (const std::size_t v : used) points += static_cast<double>(bundle_.used_points(v));
    sum += points * off * off;
    count += points;
  }
  for (const std::size_t v : used) bundle_.use_view(v, true);
  if (!all_converged) return std::nullopt;
  return std::sqrt(sum / count);
}

void Calibration::fit(const BundleState& start, double loss) {
  BundleFit next = bundle_.fit(start, fixed_, sigmas_, loss);
  if (!next.converged || !(next.state.camera[0] > 0 && next.state.camera[1] > 0))
    throw Error(kSubject, "the views do not determine a camera of model " + std::string(to_string(options_.model)));
  state_ = std::move(next.state);
}

Sigmas Calibration::robust_sigmas() const {
  std::array<std::vector<double>, kTargetKinds> sizes;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!bundle_.uses_view(v)) continue;
    for (const auto& r : bundle_.residuals(state_, v))
      if (r)
        for (const double component : {r->x(), r->y()})
          sizes[static_cast<std::size_t>(views_[v].target.kind)].push_back(std::abs(component));
  }
  Sigmas out;
  for (const TargetView& view : views_)
    out.push_back(std::max(kLeastSigma, 1.4826 * median_of(sizes[static_cast<std::size_t>(view.target.kind)])));
  return out;
}

std::size_t Calibration::parameters() const {
  std::size_t count = state_.camera.size() - fixed_.size();
  for (std::size_t v = 0; v < views_.size(); ++v) count += bundle_.uses_view(v) ? 6 : 0;
  return count;
}

Sigmas Calibration::estimated_sigmas() const {
  struct Sum {
    double squares = 0, count = 0;
  };
  std::vector<Sum> of(views_.size());
  std::array<Sum, kTargetKinds> of_kind;
  double count = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!bundle_.uses_view(v)) continue;
    const auto residuals = bundle_.residuals(state_, v);
    for (std::size_t i = 0; i < residuals.size(); ++i)
      if (bundle_.uses(v, i) && residuals[i]) {
        of[v].squares += residuals[i]->squaredNorm();
        of[v].count += 2;
      }
    Sum& kind = of_kind[static_cast<std::size_t>(views_[v].target.kind)];
    kind.squares += of[v].squares;
    kind.count += of[v].count;
    count += of[v].count;
  }
  const double left = 1 - static_cast<double>(parameters()) / std::max(1., count);
  if (!(left > 0)) throw Error(kSubject, "there are fewer measured points than unknowns");
  Sigmas out;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    const Sum& kind = of_kind[static_cast<std::size_t>(views_[v].target.kind)];
    const double usual = kind.count > 0 ? kind.squares / kind.count : 1;
    const double square = (of[v].squares + kBelief * usual) / (of[v].count + kBelief);
    out.push_back(std::max(kLeastSigma, std::sqrt(square / left)));
  }
  return out;
}

void Calibration::throw_out() {
  for (std::size_t round = 0; round < kMarkings + views_.size(); ++round) {
    bool changed = false;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const double limit = std::max(kHarmless, options_.outlier_ratio * std::sqrt(2.) * sigmas_[v]);
      const auto residuals = bundle_.residuals(state_, v);
      for (std::size_t i = 0; i < residuals.size(); ++i) {
        const bool is_inlier = residuals[i] && residuals[i]->norm() <= limit;
        changed = changed || is_inlier != bundle_.is_inlier(v, i);
        bundle_.use_point(v, i, is_inlier);
      }
    }
    if (!throw_out_worst() && (!changed || round >= kMarkings)) return;
    fit(state_, kLoss);
    sigmas_ = robust_sigmas();
  }
}

bool Calibration::place_others() {
  const CameraModel camera = camera_from(size_, options_.model, state_.camera);
  bool any = false;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (bundle_.uses_view(v)) continue;
    const auto pose = start_pose(camera, views_[v]);
    if (!pose) continue;
    BundleState next = state_;
    next.poses[v] = *pose;
    bundle_.use_view(v, true);
    if (bundle_.shows(next, v)) {
      state_ = std::move(next);
      rejected_[v].clear();
      any = true;
    } else {
      bundle_.use_view(v, false);
    }
  }
  return any;
}

void Calibration::check_view_count() const {
  const auto left = std::ranges::count(rejected_, std::string());
  if (left >= kLeastViews) return;
  const auto first = std::ranges::find_if(rejected_, [](const std::string& reason) { return !reason.empty(); });
  throw Error(kSubject, std::to_string(left) + " views agree, must be at least " + std::to_string(kLeastViews) +
                            "; one that does not: " + *first);
}

bool Calibration::throw_out_worst() {
  // Of the better three quarters of its points: single wrong ones are no reason.
  const auto off = [&](std::size_t v) {
    std::vector<double> squares;
    for (const auto& r : bundle_.residuals(state_, v)) squares.push_back(r ? r->squaredNorm() : kFarOff * kFarOff);
    std::ranges::sort(squares);
    squares.resize((3 * squares.size() + 3) / 4);
    double sum = 0;
    for (const double square : squares) sum += square;
    return std::sqrt(sum / static_cast<double>(squares.size()));
  };
  std::array<std::vector<double>, kTargetKinds> all;
  std::vector<double> of(views_.size(), 0);
  for (std::size_t v = 0; v < views_.size(); ++v)
    if (bundle_.uses_view(v)) all[static_cast<std::size_t>(views_[v].target.kind)].push_back(of[v] = off(v));
  std::optional<std::size_t> worst;
  double worst_ratio = options_.outlier_ratio;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!bundle_.uses_view(v)) continue;
    const double usual = std::max(kHarmlessView, median_of(all[static_cast<std::size_t>(views_[v].target.kind)]));
    const std::size_t inliers = bundle_.used_points(v);
    const bool is_poor = inliers < kLeastPoints || 4 * inliers < 3 * views_[v].points.size();
    const double ratio = std::max(of[v] / usual, is_poor && of[v] > kHarmlessView ? options_.outlier_ratio + of[v] : 0);
    if (ratio > worst_ratio) {
      worst = v;
      worst_ratio = ratio;
    }
  }
  if (!worst) return false;
  bundle_.use_view(*worst, false);
  rejected_[*worst] = "its points lie " + px(of[*worst]) + " off, those of the middle view " +
                      px(median_of(all[static_cast<std::size_t>(views_[*worst].target.kind)]));
  check_view_count();
  return true;
}

std::array<double, kTargetKinds> Calibration::likeness() const {
  std::array<double, kTargetKinds> products{}, squares{}, pairs{}, points{};
  double count = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    if (!bundle_.uses_view(v)) continue;
    const auto kind = static_cast<std::size_t>(views_[v].target.kind);
    const auto residuals = bundle_.residuals(state_, v);
    const auto& seen = views_[v].points;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!bundle_.uses(v, i) || !residuals[i]) continue;
      squares[kind] += residuals[i]->squaredNorm() / (sigmas_[v] * sigmas_[v]);
      ++points[kind];
      ++count;
      for (std::size_t k = 0; k < seen.size(); ++k)
        if (k != i && bundle_.uses(v, k) && residuals[k] && std::abs(seen[i].column - seen[k].column) <= 1 &&
            std::abs(seen[i].row - seen[k].row) <= 1) {
          products[kind] += residuals[i]->dot(*residuals[k]) / (sigmas_[v] * sigmas_[v]);
          ++pairs[kind];
        }
    }
  }
  // Residuals of independent errors are not independent: the fit makes neighbors differ by its share of the unknowns.
  const double share = static_cast<double>(parameters()) / (2 * std::max(1., count));
  std::array<double, kTargetKinds> out;
  out.fill(1);
  for (std::size_t kind = 0; kind < out.size(); ++kind)
    if (squares[kind] > 0)
      out[kind] = std::max(1., 1 + products[kind] / squares[kind] + share * pairs[kind] / points[kind]);
  return out;
}

Eigen::MatrixXd Calibration::covariance_now() const {
  Sigmas alike_sigmas = sigmas_;
  const auto alike_by_kind = likeness();
  for (std::size_t v = 0; v < views_.size(); ++v)
    alike_sigmas[v] *= std::sqrt(alike_by_kind[static_cast<std::size_t>(views_[v].target.kind)]);
  std::vector<FrameSigmas> alike_frames = frame_sigmas_;
  const double alike_places = std::sqrt(frame_likeness());
  for (FrameSigmas& sides : alike_frames)
    for (double& sigma : sides) sigma *= alike_places;
  const Eigen::MatrixXd information = bundle_.information(state_, alike_sigmas, alike_frames);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < information.rows(); ++i)
    if (std::ranges::find(fixed_, static_cast<int>(i)) == fixed_.end()) free.push_back(i);
  const Eigen::MatrixXd part = information(free, free);
  const Eigen::VectorXd scale = part.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::MatrixXd scaled = (part.array() / (scale * scale.transpose()).array()).matrix();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  if (!scaled.allFinite() || !(solver.eigenvalues()(0) > 1e-10))
    throw Error(kSubject, "the views do not determine the camera: show the target tilted, in different directions");
  const Eigen::MatrixXd inverse =
      solver.eigenvectors() * solver.eigenvalues().cwiseInverse().asDiagonal() * solver.eigenvectors().transpose();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(information.rows(), information.cols());
  out(free, free) = (inverse.array() / (scale * scale.transpose()).array()).matrix();
  return out;
}

}  // namespace tassilo
