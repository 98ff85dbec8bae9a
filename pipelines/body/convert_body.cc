// SPDX-License-Identifier: Apache-2.0
#include "pipelines/body/convert_body.h"

#include <utility>

#include "data_tools/body/body_io.h"
#include "pipelines/files.h"

namespace bodyloom {

ConvertBodyReport ConvertBody(const ConvertBodyRequest& request, const PipelineCallbacks& callbacks) {
  RequireReadable(request.body, "body model");
  RequireReadable(request.uv, "texture coordinates");
  RequireReadable(request.parts, "body parts");
  RequireDistinct({request.body, request.uv, request.parts}, {request.out});
  RequireWritable(request.out);
  BodyModelData body = LoadBodyData(request.body, request.load);
  callbacks.Update("convert", 0);
  if (!request.uv.empty()) {
    UvFromObj(request.uv, &body);
  }
  if (!request.parts.empty()) {
    const PartsSummary parts = PartsFromUvProcessedMat(request.parts, &body);
    callbacks.Message(std::to_string(parts.faces_with_part) + " faces have a part, " +
                      std::to_string(parts.faces_without_part) + " have none");
  }
  SaveBodyCompact(request.out, body);
  return {DescribeBody(BodyModel(std::move(body))), request.out};
}

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
  if (request.hands) body = MakeBuiltinBodyWithHands(sources);
  SaveBodyCompact(request.out, body);
  report.description = DescribeBody(BodyModel(std::move(body)));
  return report;
}

}  // namespace bodyloom
