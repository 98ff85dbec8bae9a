#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Many clips on one or several machines by GNU parallel, a shard a job (docs/batch.md):
#
#   batch_parallel.sh clips.jsonl results SHARDS [options for all clips]
#
# Several machines that share the folders: add --sshloginfile hosts --workdir . to the line of parallel. Send it again
# as often as you like: what is done stays. A shard that does not end with 0 is tried thrice.
manifest=$1 out=$2 shards=$3
mkdir -p "$out"
parallel --jobs 100% --ungroup --retries 3 --joblog "$out/parallel.log" \
  bodyloom batch --manifest "$manifest" --out "$out" --shard {}/"$shards" --jobs 1 --threads 1 --quiet "${@:4}" \
  ::: $(seq 0 $((shards - 1)))
