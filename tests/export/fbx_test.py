#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exports a synthetic clip as FBX with every rig and checks bones, joints, surface and camera in Blender.

usage: fbx_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: joints within 0.1 mm, surface within a millimetre; 1: not; 77: no Blender here, or no NumPy.
"""
import json
import pathlib
import sys
import tempfile

from in_blender import command_in, require_blender, run_in_blender, write_changed_track

FPS, SHIFT_PX = "30", (31.0, -17.0)
JOINT_LIMIT_MM, SURFACE_LIMIT_MM = 0.1, 1.0
# The 22 joints of SMPL in its order, as the programs name them; what the rest pose's left arm does.
RIGS = {
    "smpl": ("pelvis l_hip r_hip spine1 l_knee r_knee spine2 l_ankle r_ankle spine3 l_foot r_foot neck l_collar r_collar head "
             "l_shoulder r_shoulder l_elbow r_elbow l_wrist r_wrist", 0),
    "mixamo": ("mixamorig:Hips mixamorig:LeftUpLeg mixamorig:RightUpLeg mixamorig:Spine mixamorig:LeftLeg mixamorig:RightLeg "
               "mixamorig:Spine1 mixamorig:LeftFoot mixamorig:RightFoot mixamorig:Spine2 mixamorig:LeftToeBase "
               "mixamorig:RightToeBase mixamorig:Neck mixamorig:LeftShoulder mixamorig:RightShoulder mixamorig:Head "
               "mixamorig:LeftArm mixamorig:RightArm mixamorig:LeftForeArm mixamorig:RightForeArm mixamorig:LeftHand "
               "mixamorig:RightHand", 0),
    "unreal": ("pelvis thigh_l thigh_r spine_01 calf_l calf_r spine_02 foot_l foot_r spine_03 ball_l ball_r neck_01 clavicle_l "
               "clavicle_r head upperarm_l upperarm_r lowerarm_l lowerarm_r hand_l hand_r", 45),
    "vrm": ("hips leftUpperLeg rightUpperLeg spine leftLowerLeg rightLowerLeg chest leftFoot rightFoot upperChest leftToes "
            "rightToes neck leftShoulder rightShoulder head leftUpperArm rightUpperArm leftLowerArm rightLowerArm leftHand "
            "rightHand", 0),
}


def main():
    require_blender()
    with tempfile.TemporaryDirectory() as folder:
        bodyloom = command_in(folder)
        bodyloom("synth", "--motion", "demo", "--frames", "24", "--first", "60", "--fps", FPS, "--out", "clip", "--camera-motion",
                 "walking", "--quiet")
        write_changed_track(pathlib.Path(folder) / "clip" / "truth.npz", pathlib.Path(folder) / "track.npz", SHIFT_PX)
        for what in ("vertices", "joints"):
            bodyloom("export", "--track", "track.npz", "--what", what, "--axes", "world", "--out", f"{what}.npy")
        good = True
        for rig, (names, arm_down_deg) in RIGS.items():
            # The same person twice: every armature is judged.
            bodyloom("export", "--track", "track.npz", "--track", "track.npz", "--what", "fbx", "--rig", rig, "--correctives", "16",
                     "--out", f"{rig}.fbx")
            request = {"fbx": f"{rig}.fbx", "joints": "joints.npy", "vertices": "vertices.npy", "track": "track.npz",
                       "names": names.split(), "arm_down_deg": arm_down_deg, "fps": float(FPS), "joint_limit_mm": JOINT_LIMIT_MM,
                       "surface_limit_mm": SURFACE_LIMIT_MM}
            good = run_in_blender("fbx_in_blender.py", [json.dumps(request)], folder) and good
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
