#include "lens/orthogonal_columns.h"

namespace etendue {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd OrthogonalColumns::add(VectorXd column) {
    const Index count = static_cast<Index>(directions_.size());
    const double squaredBefore = column.squaredNorm();
    VectorXd along = VectorXd::Zero(count + 1);
    for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan and Parlett)
        for (Index i = 0; i < count; ++i) {
            const VectorXd& direction = directions_[static_cast<std::size_t>(i)];
            const double share = direction.dot(column);
            column -= share * direction;
            along[i] += share;
        }
    const double length = column.norm();
    if (length * length > dependentShare * squaredBefore) {
        column /= length;
        along[count] = length;
    } else {  // a column of no use: its coefficient comes out as zero
        column.setZero();
        along.setZero();
        along[count] = 1.0;
    }
    directions_.push_back(column);
    triangle_.push_back(along);
    shares_.push_back(column.transpose() * residual_);
    residual_.noalias() -= column * shares_.back();
    return column;
}

MatrixXd OrthogonalColumns::triangle() const {
    const Index count = static_cast<Index>(triangle_.size());
    MatrixXd result = MatrixXd::Zero(count, count);
    for (Index i = 0; i < count; ++i)
        result.col(i).head(i + 1) = triangle_[static_cast<std::size_t>(i)];
    return result;
}

MatrixXd OrthogonalColumns::shares() const {
    MatrixXd result(static_cast<Index>(shares_.size()), residual_.cols());
    for (std::size_t i = 0; i < shares_.size(); ++i) result.row(static_cast<Index>(i)) = shares_[i];
    return result;
}

}  // namespace etendue
