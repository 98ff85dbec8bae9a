// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/body/build_builtin_body.h"

#include <utility>

#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/body/builtin_body.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {

BuildBuiltinBodyReport BuildBuiltinBody(const BuildBuiltinBodyRequest& request, const PipelineCallbacks& callbacks) {
  RequireReadable(request.cage, "cage");
  RequireReadable(request.parts, "parts on the cage");
  RequireDistinct({request.cage, request.parts}, {request.out});
  RequireWritable(request.out);
  const BuiltinBodySources sources =
      request.cage.empty() ? EmbeddedBuiltinBodySources() : ReadBuiltinBodySources(request.cage, request.parts);
  callbacks.Update("build", 0);
  BuildBuiltinBodyReport report;
  report.out = request.out;
  BodyModelData body = MakeBuiltinBody(sources, &report.summary);
  SaveBodyCompact(request.out, body);
  report.description = DescribeBody(BodyModel(std::move(body)));
  return report;
}

}  // namespace bodyloom
