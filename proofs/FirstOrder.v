(** Values and derivatives at ε = 0, by the rules of differentiation. A tactic finds those of an expression from
    those of its parts. *)

From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Import Model Sums.

Open Scope R_scope.

(** Components of vector expressions are computed, those of the packing's own vectors are kept. *)
Global Arguments position : simpl never.
Global Arguments delta_x : simpl never.
Global Arguments N_plus : simpl never.
Global Arguments N_minus : simpl never.
Global Arguments delta_n_plus : simpl never.
Global Arguments delta_n_minus : simpl never.
Ltac components :=
  cbn [x_of y_of add scale minus matrix dot zero downwards b_plus b_minus n_plus n_minus e_y].
Tactic Notation "components" "in" hyp(H) :=
  cbn [x_of y_of add scale minus matrix dot zero downwards b_plus b_minus n_plus n_minus e_y] in H.

(** ** Neighbourhoods of 0 *)

Lemma near_always (P : R -> Prop) : (forall e, P e) -> near P.
Proof. intros H. exists 1. split; [lra|auto]. Qed.

Lemma near_both (P Q : R -> Prop) : near P -> near Q -> near (fun e => P e /\ Q e).
Proof.
  intros (a & Ha & HP) (b & Hb & HQ). exists (Rmin a b). split; [apply Rmin_pos; assumption|].
  intros e He. split.
  - apply HP. eapply Rlt_le_trans; [exact He|apply Rmin_l].
  - apply HQ. eapply Rlt_le_trans; [exact He|apply Rmin_r].
Qed.

Lemma near_then (P Q : R -> Prop) : near P -> (forall e, P e -> Q e) -> near Q.
Proof. intros (a & Ha & H) HQ. exists a. split; auto. Qed.

Lemma near_zero (P : R -> Prop) : near P -> P 0.
Proof. intros (a & Ha & H). apply H. rewrite Rabs_R0. exact Ha. Qed.

(** ** Rules of differentiation *)

Lemma expands_near f g v d : expands f v d -> near (fun e => f e = g e) -> expands g v d.
Proof.
  intros [<- H] (a & Ha & E). split; [symmetry; apply E; rewrite Rabs_R0; exact Ha|].
  intros eps Heps. destruct (H eps Heps) as [delta Hd].
  assert (Hmin : 0 < Rmin delta a) by (apply Rmin_pos; [apply cond_pos|exact Ha]).
  exists (mkposreal _ Hmin). cbn. intros h Hh Hh'.
  assert (h_delta : Rabs h < delta) by (eapply Rlt_le_trans; [exact Hh'|apply Rmin_l]).
  assert (h_a : Rabs h < a) by (eapply Rlt_le_trans; [exact Hh'|apply Rmin_r]).
  rewrite <- !E; [apply Hd; assumption|rewrite Rabs_R0; exact Ha|].
  replace (0 + h) with h by ring. exact h_a.
Qed.

Lemma expands_const c : expands (fun _ => c) c 0.
Proof. split; [reflexivity|apply derivable_pt_lim_const]. Qed.

Lemma expands_id : expands (fun e => e) 0 1.
Proof. split; [reflexivity|apply derivable_pt_lim_id]. Qed.

Lemma expands_plus f g v d w c : expands f v d -> expands g w c ->
  expands (fun e => f e + g e) (v + w) (d + c).
Proof.
  intros [<- Hf] [<- Hg]. split; [reflexivity|].
  apply (derivable_pt_lim_plus f g 0 d c Hf Hg).
Qed.

Lemma expands_opp f v d : expands f v d -> expands (fun e => - f e) (- v) (- d).
Proof. intros [<- H]. split; [reflexivity|]. apply (derivable_pt_lim_opp f 0 d H). Qed.

Lemma expands_minus f g v d w c : expands f v d -> expands g w c ->
  expands (fun e => f e - g e) (v - w) (d - c).
Proof.
  intros [<- Hf] [<- Hg]. split; [reflexivity|].
  apply (derivable_pt_lim_minus f g 0 d c Hf Hg).
Qed.

Lemma expands_mult f g v d w c : expands f v d -> expands g w c ->
  expands (fun e => f e * g e) (v * w) (d * w + v * c).
Proof.
  intros [<- Hf] [<- Hg]. split; [reflexivity|].
  apply (derivable_pt_lim_mult f g 0 d c Hf Hg).
Qed.

Lemma expands_div f g v d w c : w <> 0 -> expands f v d -> expands g w c ->
  expands (fun e => f e / g e) (v / w) ((d * w - c * v) / (w * w)).
Proof.
  intros Hw [<- Hf] [<- Hg]. split; [reflexivity|].
  apply (derivable_pt_lim_div f g 0 d c Hf Hg Hw).
Qed.

Lemma expands_sqrt f v d : 0 < v -> expands f v d -> expands (fun e => sqrt (f e)) (sqrt v) (d / (2 * sqrt v)).
Proof.
  intros Hv [<- Hf]. split; [reflexivity|].
  replace (d / (2 * sqrt (f 0))) with (/ (2 * sqrt (f 0)) * d)
    by (field; apply Rgt_not_eq, sqrt_lt_R0, Hv).
  apply (derivable_pt_lim_comp f sqrt 0 d _ Hf). apply derivable_pt_lim_sqrt, Hv.
Qed.

Lemma expands_pow2 f v d : expands f v d -> expands (fun e => f e ^ 2) (v ^ 2) (2 * v * d).
Proof.
  intros H. replace (v ^ 2) with (v * v) by ring.
  replace (2 * v * d) with (d * v + v * d) by ring.
  apply (expands_near (fun e => f e * f e)); [apply expands_mult; exact H|].
  apply near_always. intros e. ring.
Qed.

Lemma expands_unique f v d w c : expands f v d -> expands f w c -> v = w /\ d = c.
Proof. intros [<- H] [<- H']. split; [reflexivity|]. exact (uniqueness_limite f 0 d c H H'). Qed.

Lemma expands_to f v d w c : expands f v d -> v = w -> d = c -> expands f w c.
Proof. intros H <- <-. exact H. Qed.

Lemma expands_sum low high (f : Z -> R -> R) v d :
  (forall m, (low <= m <= high)%Z -> expands (f m) (v m) (d m)) ->
  expands (fun e => Sum low high (fun m => f m e)) (Sum low high v) (Sum low high d).
Proof.
  unfold Sum. intros H.
  assert (H' : forall m, (low <= m < low + Z.of_nat (Z.to_nat (high - low + 1)))%Z ->
    expands (f m) (v m) (d m)) by (intros; apply H; lia).
  clear H. induction (Z.to_nat (high - low + 1)) as [|n IH]; cbn [sum_from].
  - apply expands_const.
  - apply expands_plus; [apply IH; intros; apply H'; lia|apply H'; lia].
Qed.

Lemma continuous_near_positive f : continuity_pt f 0 -> 0 < f 0 -> near (fun e => 0 < f e).
Proof.
  intros C Hv. destruct (C (f 0) Hv) as (a & Ha & Hc). exists a. split; [exact Ha|]. intros e He.
  destruct (Req_dec e 0) as [->|Hne]; [exact Hv|].
  assert (D : R_dist (f e) (f 0) < f 0).
  { apply Hc. split; [split; [exact I|auto]|]. cbn. unfold R_dist. rewrite Rminus_0_r. exact He. }
  unfold R_dist in D. apply Rabs_def2 in D. lra.
Qed.

Lemma expands_continuous f v d : expands f v d -> continuity_pt f 0.
Proof. intros [_ H]. exact (derivable_continuous_pt f 0 (exist _ d H)). Qed.

Lemma expands_near_positive f v d : expands f v d -> 0 < v -> near (fun e => 0 < f e).
Proof.
  intros H Hv. apply continuous_near_positive; [exact (expands_continuous _ _ _ H)|].
  destruct H as [-> _]. exact Hv.
Qed.

Lemma expands_near_nonzero f v d : expands f v d -> v <> 0 -> near (fun e => f e <> 0).
Proof.
  intros H Hv. destruct (Rtotal_order v 0) as [Hn|[->|Hp]].
  - eapply near_then; [apply (expands_near_positive _ _ _ (expands_opp _ _ _ H)); lra|].
    cbn. intros e He. lra.
  - contradiction.
  - eapply near_then; [apply (expands_near_positive _ _ _ H Hp)|]. cbn. intros e He. lra.
Qed.

Lemma first_order_by f g v d w c :
  expands f v d -> expands g w c -> v = w -> d = c -> first_order f g.
Proof. intros Hf Hg <- <-. exists v, d. split; assumption. Qed.

(** Finds value and slope of a function that is built from known ones. *)
Ltac expand_with known :=
  lazymatch goal with
  | |- expands (fun _ => ?c) _ _ => apply expands_const
  | |- expands (fun e => e) _ _ => apply expands_id
  | |- expands (fun e => @?f e + @?g e) _ _ => apply (expands_plus f g); expand_with known
  | |- expands (fun e => @?f e - @?g e) _ _ => apply (expands_minus f g); expand_with known
  | |- expands (fun e => - @?f e) _ _ => apply (expands_opp f); expand_with known
  | |- expands (fun e => @?f e * @?g e) _ _ => apply (expands_mult f g); expand_with known
  | |- expands (fun e => @?f e / @?g e) _ _ =>
      apply (expands_div f g); [|expand_with known|expand_with known]
  | |- expands (fun e => Sum ?a ?b (fun m => @?f m e)) _ _ =>
      refine (expands_to _ _ _ _ _
        (expands_sum a b (fun m e => f m e) (fun m => _) (fun m => _) (fun m Hm => _)) _ _);
      [cbv beta; expand_with known|reflexivity|reflexivity]
  | |- _ => known tt
  end.
