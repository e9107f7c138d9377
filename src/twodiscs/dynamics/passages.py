"""The constants of all kernels that follow hops for their transmission coefficient."""

#: Replicas that share a random stream.
REPLICAS = 64

#: Clusters of this many hops, or more, are in one class. It counts as even, which makes κ too small
#: by less than the fraction of hops in it over their number.
LARGEST = 2**13

#: The sums at each time: n = Σ s_0 s_k and n², N hops and N².
SUMS = 4
