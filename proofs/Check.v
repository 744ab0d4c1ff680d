
From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Import Model Sums FirstOrder Geometry.
Open Scope R_scope.
(** ** Sites and sums that differ in how their indices are written *)

Ltac same_atoms := idtac.

Ltac atoms_of P :=
  lazymatch goal with
  | |- expands (fun e => delta_r ?rho ?i ?j e) _ _ => apply delta_r_expands
  | |- expands (fun e => x_of (delta_x ?X ?i ?j e)) _ _ => apply (delta_x_x_expands _ _ _ _ P); site
  | |- expands (fun e => y_of (delta_x ?X ?i ?j e)) _ _ => apply (delta_x_y_expands _ _ _ _ P); site
  | |- expands (fun e => x_of (delta_n_plus _ ?X ?i ?j e)) _ _ => apply (delta_n_plus_x_expands _ _ _ _ P); site
  | |- expands (fun e => y_of (delta_n_plus _ ?X ?i ?j e)) _ _ => apply (delta_n_plus_y_expands _ _ _ _ P); site
  | |- expands (fun e => x_of (delta_n_minus _ ?X ?i ?j e)) _ _ => apply (delta_n_minus_x_expands _ _ _ _ P); site
  | |- expands (fun e => y_of (delta_n_minus _ ?X ?i ?j e)) _ _ => apply (delta_n_minus_y_expands _ _ _ _ P); site
  | |- ?g => idtac "no rule:" g; fail
  end.
Ltac components := cbn [x_of y_of add scale minus matrix b_plus b_minus n_plus n_minus e_y zero].
Theorem equation_3 G M rho X : packing G M rho X -> forall i j, bead M i j -> (1 <= j)%Z ->
 first_order_vector (fun e => delta_x X i j e) (fun e => add (scale (delta_r rho (i-j) 0 e + delta_r rho i j e + 2 * Sum 1 (j-1) (fun m => delta_r rho (i - j + m) m e)) (b_plus G)) (scale (delta_r rho (i+j) 0 e + delta_r rho i j e + 2 * Sum 1 (j-1) (fun m => delta_r rho (i + j - m) m e)) (b_minus G)) ).
Proof.
intros P i j H Hj.
split; components; (eapply first_order_by; [expand_with ltac:(fun _ => atoms_of P)| expand_with ltac:(fun _ => atoms_of P) | |]).
all: cbv beta.
