// SPDX-License-Identifier: Apache-2.0
/// GAN losses of discriminator and generator from logits D. Internal: includes LibTorch.
///
///   kNonSaturating: discriminator ½ (mean softplus(−D(real)) + mean softplus(D(fake))), generator mean
///     softplus(−D(fake)) (binary cross entropy; Goodfellow et al. 2014, its non-saturating form for the generator);
///   kLeastSquares: ½ (mean (D(real) − 1)² + mean D(fake)²), mean (D(fake) − 1)² (Mao et al. 2017).
/// Several scales are summed, as Wang et al., CVPR 2018 do.
///
/// In the discriminator's step pass D(fake.detach()); in the generator's step disable requires_grad of the
/// discriminator's parameters to avoid computing their gradients.
#pragma once

#include <torch/torch.h>

#include <vector>

namespace bodyloom {

enum class GanLossKind { kNonSaturating, kLeastSquares };

/// One tensor of logits per scale, of any shape; as many real as fake, at least one.
torch::Tensor DiscriminatorLoss(const std::vector<torch::Tensor>& real_logits,
                                const std::vector<torch::Tensor>& fake_logits,
                                GanLossKind kind = GanLossKind::kNonSaturating);
torch::Tensor GeneratorLoss(const std::vector<torch::Tensor>& fake_logits,
                            GanLossKind kind = GanLossKind::kNonSaturating);

}  // namespace bodyloom
