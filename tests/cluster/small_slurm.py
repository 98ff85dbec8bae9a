# SPDX-License-Identifier: Apache-2.0
"""A Slurm of one node on this machine, as Debian packages it, without systemd and without cgroups.

with SmallSlurm(folder, cpus=2) as slurm: slurm.call("sbatch", "script") ...

A requeued job waits until the credentials of its first start have expired, ten seconds here (Slurm's default is two
minutes). Needs root, since slurmd starts jobs as their users do. Everything lies in `folder`, ports are free ones.
"""
import os
import pathlib
import shutil
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "scancel", "sinfo")


def what_is_missing():
    """One line on why there can be no Slurm here, or an empty one."""
    if os.geteuid() != 0:
        return "not root"
    missing = [name for name in PROGRAMS if not shutil.which(name, path=os.environ["PATH"] + ":/usr/sbin")]
    return "no " + ", ".join(missing) if missing else ""


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


CONFIG = """\
ClusterName=small
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmctldPort={control_port}
SlurmdPort={node_port}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=10
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/jobs.txt
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2
ReturnToService=2
MpiDefault=none
KillWait=15
MinJobAge=100000
SlurmdParameters=config_overrides
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=60 State=UP
"""


class SmallSlurm:
    def __init__(self, folder, cpus):
        self.folder = pathlib.Path(folder)
        self.cpus = cpus
        self.daemons = []
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf"),
                            "PATH": os.environ["PATH"] + ":/usr/sbin"}

    def call(self, *words):
        """What a command prints; throws when it fails."""
        return subprocess.run(words, env=self.environment, cwd=self.folder, check=True, capture_output=True,
                              text=True).stdout

    def start(self, *words):
        log = open(self.folder / (pathlib.Path(words[0]).name + ".out"), "w")
        self.daemons.append(subprocess.Popen(words, env=self.environment, stdout=log, stderr=subprocess.STDOUT,
                                             stdin=subprocess.DEVNULL))

    def __enter__(self):
        self.folder.mkdir(parents=True, exist_ok=True)
        os.chmod(self.folder, 0o755)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        os.chmod(key, 0o400)
        host = socket.gethostname().split(".")[0]
        (self.folder / "slurm.conf").write_text(CONFIG.format(host=host, folder=self.folder, cpus=self.cpus,
                                                              control_port=free_port(), node_port=free_port()))
        self.start("munged", "--foreground", "--force", f"--socket={self.folder}/munge.socket", f"--key-file={key}",
                   f"--pid-file={self.folder}/munge.pid", f"--seed-file={self.folder}/munge.seed",
                   f"--log-file={self.folder}/munge.log")
        self.wait(lambda: (self.folder / "munge.socket").exists(), "munged")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        self.wait(self.is_idle, "a node")
        return self

    def is_idle(self):
        answer = subprocess.run(["sinfo", "-h", "-o", "%T"], env=self.environment, capture_output=True, text=True)
        return answer.stdout.strip() == "idle"

    def wait(self, what, name, seconds=180):
        end = time.time() + seconds
        while not what():
            if time.time() > end:
                raise RuntimeError(f"{name}: not there after {seconds} s, see the logs in {self.folder}")
            time.sleep(0.1)

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in reversed(self.daemons):
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()

    def state_of(self, job, task):
        """State and number of restarts of a task of an array, as scontrol shows them."""
        shown = dict(word.split("=", 1) for word in self.call("scontrol", "show", "job", f"{job}_{task}", "-o").split()
                     if "=" in word)
        return shown["JobState"], int(shown["Restarts"])

    def drained(self):
        return not self.call("squeue", "-h").strip()
