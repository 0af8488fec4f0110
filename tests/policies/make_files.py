"""Makes the files of this folder, with PyTorch 1.13 (Debian: python3-torch). What they compute is in answers.npz.

python3 make_files.py
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import torch
from torch import nn

FOLDER = Path(__file__).resolve().parent


class Recurrent(nn.Module):
    """A recurrent layer and a linear one."""

    def __init__(self, kind: type[nn.RNNBase]) -> None:
        """Make the layers."""
        super().__init__()
        self.memory = kind(3, 5, batch_first=True)
        self.head = nn.Linear(5, 2)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """Return the outputs of all steps."""
        return self.head(self.memory(x)[0])


torch.manual_seed(0)
x = torch.linspace(-1, 1, 12).reshape(1, 4, 3)
plain = nn.Sequential(nn.Linear(3, 8), nn.Tanh(), nn.Linear(8, 2))
answers = {"x": x.numpy(), "plain": plain(x).detach().numpy()}
torch.save(plain.state_dict(), FOLDER / "plain.pt")
torch.save(plain, FOLDER / "whole.pt")
torch.save(plain.state_dict(), FOLDER / "old.pt", _use_new_zipfile_serialization=False)
torch.onnx.export(plain, torch.zeros(1, 3), FOLDER / "plain.onnx", opset_version=13)
for name, kind in (("gru", nn.GRU), ("rnn", nn.RNN), ("lstm", nn.LSTM)):
    module = Recurrent(kind)
    answers[name] = module(x).detach().numpy()
    torch.save(module.state_dict(), FOLDER / f"{name}.pt")
    if name != "lstm":
        torch.onnx.export(module, torch.zeros(1, 1, 3), FOLDER / f"{name}.onnx", opset_version=13)
normalised = nn.Sequential(nn.Linear(3, 4), nn.BatchNorm1d(4), nn.ReLU(), nn.Linear(4, 2))
torch.save(normalised.state_dict(), FOLDER / "batchnorm.pt")
np.savez(FOLDER / "answers.npz", **answers)
