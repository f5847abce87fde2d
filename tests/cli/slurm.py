# SPDX-License-Identifier: Apache-2.0
"""A Slurm cluster of two nodes on this machine, in a folder of its own."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import time

DAEMONS = ("munged", "slurmctld", "slurmd")
START_S = 30

CONFIGURATION = """\
ClusterName=contrejour
SlurmctldHost=localhost
SlurmctldPort={controller}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port={first} CPUs=1
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port={second} CPUs=1
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
"""


def reason_against():
    """Why no cluster can be started here, or an empty text."""
    path = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
    missing = [name for name in DAEMONS if not shutil.which(name, path=path)]
    if missing:
        return f"not installed: {', '.join(missing)}"
    return "" if os.geteuid() == 0 else "Slurm's daemons need root"


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for one in sockets:
        one.bind(("127.0.0.1", 0))
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    """Start it, and stop it by a with statement. The environment is that for sbatch, squeue and whatever calls them."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.environment = dict(os.environ, SLURM_CONF=str(self.folder / "slurm.conf"),
                                PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")

    def start(self):
        (self.folder / "state").mkdir(parents=True)
        controller, first, second = free_ports(3)
        (self.folder / "slurm.conf").write_text(
            CONFIGURATION.format(folder=self.folder, controller=controller, first=first, second=second))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        try:
            self.run("munged", "--force", f"--key-file={key}", *(f"--{name}-file={self.folder}/munge.{name}" for name in
                     ("pid", "log", "seed")), f"--socket={self.folder}/munge.socket")
            self.run("slurmctld")
            for node in ("n1", "n2"):
                self.run("slurmd", "-N", node)
            self.wait_for_nodes()
        except Exception:
            self.stop()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def run(self, *command):
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=60)
        if done.returncode != 0:
            raise RuntimeError(f"{command}: {done.stdout}{done.stderr}{self.logs()}")
        return done.stdout

    def wait_for_nodes(self):
        for _ in range(10 * START_S):
            states = subprocess.run(["sinfo", "-h", "-N", "-o", "%T"], env=self.environment, capture_output=True, text=True)
            if states.stdout.split() == ["idle", "idle"]:
                return
            time.sleep(0.1)
        raise RuntimeError(f"the nodes are not idle: {states.stdout}{states.stderr}{self.logs()}")

    def logs(self):
        return "".join(f"\n{log.name}: {log.read_text()[-600:]}" for log in sorted(self.folder.glob("*.log")))

    def stop(self):
        for file in ("slurmd-n1.pid", "slurmd-n2.pid", "slurmctld.pid", "munge.pid"):
            try:
                os.kill(int((self.folder / file).read_text()), signal.SIGTERM)
            except (OSError, ValueError):
                pass  # it has not started, or has ended
        time.sleep(0.5)  # the daemons write their state into the folder before they end
