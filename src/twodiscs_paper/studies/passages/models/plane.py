"""Diffusion of two discs in the plane of their positions x₁, x₂ along a channel with ends.

With frequent kicks each x diffuses with the coefficient 1/(4γ), and heights are spread evenly over
the room ρ(u) = L² that they have at the separation u = x₁ − x₂, with L = ε + σ − √(σ² − u²) for
|u| < σ, else L = ε + σ. On the square [0, A]² with walls that reflect, the slowest mode
∇·(ρ∇φ) = −λρφ is odd in u. It decays at the rate 2κ/τ, so κ = λτ/(8γ), where τ is (3π/4) V/S.

The modes are symmetric about both diagonals, so a quarter of the square is enough: 0 ≤ u ≤ w ≤ A
with w = x₁ + x₂, and φ = 0 at u = 0. It is cut into right triangles with linear elements. Their
corners crowd where u or w is small, on a scale of √(εσ).

For √(εσ) ≪ A the pair passes at any place along the channel, except near its ends, where lines
of flow cannot turn round the corner: k = ¾ (1 − 1.880 √(εσ)/A + ¾ ε/σ + …). The centre of mass
does not relax while the pair crosses. If it did, 1.880 would be 2√2/π = 0.900.
"""

import math

import numpy as np
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import eigsh

#: Elements along u for the coarse one of two solutions, whose errors fall as the square of them.
ELEMENTS = 32


def scaled_coefficient(along, room, sigma):
    """Return κx of discs that diffuse, with x = γ√(εσ): 3/4 if √(εσ) is short against A.

    The discs have the range A = ``along`` along the channel, the ``room`` ε and the distance
    ``sigma`` at contact.
    """
    coarse, fine = (_solved(along, room, sigma, n * ELEMENTS) for n in (1, 2))
    return (4 * fine - coarse) / 3


def _solved(along, room, sigma, n):
    """Return κx from ``n`` elements along u and along w."""
    neck = math.sqrt(room * sigma)
    corners = neck * np.sinh(np.linspace(0, math.asinh(along / neck), n + 1))
    sides, number = np.diff(corners), np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    i, j = np.triu_indices(n)
    mass, pairs = np.zeros(number.size), []
    # A cell has a triangle above its diagonal; below it another one, unless it is on u = w.
    for upper in (True, False):
        i, j = (i, j) if upper else (part[i < j] for part in (i, j))
        right, low, high = (i, j + 1) if upper else (i + 1, j), (i, j), (i + 1, j + 1)
        u = corners[i] + sides[i] * (1 if upper else 2) / 3
        near = np.minimum(u, sigma)
        size = (room + near**2 / (sigma + np.sqrt(sigma**2 - near**2))) ** 2
        across, along_w = (high, low) if upper else (low, high)
        pairs.append((number[right], number[across], size * sides[j] / sides[i] / 2))
        pairs.append((number[right], number[along_w], size * sides[i] / sides[j] / 2))
        for corner in (right, low, high):
            np.add.at(mass, number[corner], size * sides[i] * sides[j] / 6)
    one, other, weight = (np.concatenate(part) for part in zip(*pairs, strict=True))
    ends = np.concatenate([one, other]), np.concatenate([other, one])
    links = coo_array((np.tile(weight, 2), ends), shape=(number.size, number.size)).tocsr()
    free = np.triu(number, 0)[1:][np.triu(np.ones((n + 1, n + 1), bool))[1:]]
    stiffness = (diags_array(links.sum(axis=1)) - links)[free][:, free]
    # In u and w the Laplacian is twice the sum of their second derivatives; the square is twice
    # the sum of all masses.
    parts = stiffness.tocsc(), diags_array(mass[free]).tocsc()
    # The start is given, because a random one changes the last digits. The sums of weights round,
    # so the eigenvalue of the matrix has an error of 1e-8. Rayleigh's quotient is a sum of squares:
    # its error is the square of that of the mode.
    _, modes = eigsh(parts[0], 1, parts[1], sigma=0, v0=np.ones(free.size))
    mode = np.zeros(number.size)
    mode[free] = modes[:, 0]
    slowest = (weight * (mode[one] - mode[other]) ** 2).sum() / (mass * mode**2).sum()
    tau = 3 * math.pi / 4 * 2 * mass.sum() / (math.sqrt(2) * along * room**2)
    return float(2 * slowest * tau * neck / 8)
